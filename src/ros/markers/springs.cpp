#include "ros/markers/picture.hpp"
#include <spring_pendulum/model/dynamics.hpp>

#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kWider = 0.7;  ///< a chain behind others is wider by this share per chain

/// Returns the strain in full colour: twice the strain of the first spring of the hanging chain.
double fullColorStrain(const Chain& chain) {
  const SpringLaw& spring = chain.spring();
  const double weight = chain.masses().tail(chain.size() - 1).sum() * std::abs(chain.gravity());
  const double stretch = spring.stiffness > 0.0 ? weight / spring.stiffness : 0.0;
  const double strain = spring.rest_length > 0.0 ? stretch / spring.rest_length : stretch;
  return std::clamp(2.0 * strain, 0.05, 5.0);
}

/// \param strain -1 and below: full blue; 0: white; 1: full red; 8 and above: dark red
std_msgs::ColorRGBA strainColor(double strain) {
  const std_msgs::ColorRGBA stretched = colorOf(0xff3b20);
  if (strain > 1.0) return mix(stretched, colorOf(0x8c0a32), std::log2(strain) / 3.0);
  return mix(colorOf(0xf2f2f2), strain < 0.0 ? colorOf(0x2f7bff) : stretched, std::abs(strain));
}

}  // namespace

void drawSprings(const Picture& picture, Marker& springs) {
  const Run& run = picture.run;
  setScale(springs, picture.width() * (1.0 + kWider * picture.chainsInFront()));
  springs.pose.position.y = (1.0 + picture.chainsInFront()) * picture.depth();
  if (picture.isDrawable()) {
    springs.points.clear();
    springs.colors.clear();
    const double full = fullColorStrain(run.chain());
    for (std::size_t n = 1; n < picture.drawn.size(); ++n) {
      const Eigen::Index from = picture.drawn[n - 1], to = picture.drawn[n];
      const double length = springLengths(run.state(), from, to) / static_cast<double>(to - from);
      const auto color =
          !picture.options.color.empty() ? colorOf(picture.options.color)
          : isBad(run.verdict().kind)
              ? colorOf(kDoubtColor)
              : strainColor(strainOf(length, run.chain().spring().rest_length) / full);
      for (const Eigen::Index end : {from, to}) {
        springs.points.push_back(pointOf(run.state(), end));
        springs.colors.push_back(color);
      }
    }
  }
  if (picture.isDiverged()) springs.colors.assign(springs.points.size(), colorOf(kDivergedColor));
}

}  // namespace spring_pendulum

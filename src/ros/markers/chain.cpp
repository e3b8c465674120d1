// The chain: springs, particles and the anchor.
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

std_msgs::ColorRGBA massColor(double mass, double lightest, double heaviest) {
  const double span = std::log(heaviest / lightest);
  return mix(colorOf(0xffe28a), colorOf(0xb04bff),
             span > 0.0 ? std::log(mass / lightest) / span : 0.0);
}

}  // namespace

void drawSprings(const Picture& picture, Marker& springs) {
  const Run& run = picture.run;
  setScale(springs, picture.width() * (1.0 + kWider * picture.chainsInFront()));
  springs.pose.position.y = (1.0 + picture.chainsInFront()) * picture.depth();
  if (!picture.isDrawable()) return;
  springs.points.clear();
  springs.colors.clear();
  const double full = fullColorStrain(run.chain());
  for (std::size_t n = 1; n < picture.drawn.size(); ++n) {
    const Eigen::Index from = picture.drawn[n - 1], to = picture.drawn[n];
    const double length = springLengths(run.state(), from, to) / static_cast<double>(to - from);
    const auto color = !picture.options.color.empty() ? colorOf(picture.options.color)
                       : isBad(run.verdict().kind)
                           ? colorOf(kDoubtColor)
                           : strainColor(strainOf(length, run.chain().spring().rest_length) / full);
    for (const Eigen::Index end : {from, to}) {
      springs.points.push_back(pointOf(run.state(), end));
      springs.colors.push_back(color);
    }
  }
}

void drawParticles(const Picture& picture, Marker& particles) {
  const Chain& chain = picture.run.chain();
  setScale(particles, picture.diameter());
  particles.pose.position.y = picture.chainsInFront() * picture.depth();
  if (!picture.isDrawable()) return;
  particles.points.clear();
  particles.colors.clear();
  const auto moving = chain.masses().tail(chain.size() - 1).array();
  const double lightest = moving.minCoeff(), heaviest = moving.maxCoeff();
  for (const Eigen::Index i : picture.drawn) {
    particles.points.push_back(pointOf(picture.run.state(), i));
    const double mass = i > 0 ? chain.masses()[i] : lightest;
    particles.colors.push_back(i > 0 && chain.isHeld(i) ? colorOf(kHeldColor)
                               : !picture.options.color.empty()
                                   ? mix(colorOf(picture.options.color), colorOf(0xffffff), 0.5)
                                   : massColor(mass, lightest, heaviest));
  }
}

void drawAnchor(const Picture& picture, Marker& anchor) {
  setScale(anchor, 1.5 * picture.diameter());
  anchor.scale.y = 0.01 * picture.diameter();  // flat: its underside would be black
  anchor.color = colorOf(kHeldColor);
  if (picture.run.isFinite())
    anchor.pose.position = pointOf(picture.run.state(), 0, -picture.depth());
}

}  // namespace spring_pendulum

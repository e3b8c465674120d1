#include "ros/markers/picture.hpp"

#include <cmath>

namespace spring_pendulum {
namespace {

std_msgs::ColorRGBA massColor(double mass, double lightest, double heaviest) {
  const double span = std::log(heaviest / lightest);
  return mix(colorOf(0xffe28a), colorOf(0xb04bff),
             span > 0.0 ? std::log(mass / lightest) / span : 0.0);
}

}  // namespace

void drawParticles(const Picture& picture, Marker& particles) {
  const Chain& chain = picture.run.chain();
  setScale(particles, picture.diameter());
  particles.pose.position.y = picture.chainsInFront() * picture.depth();
  if (picture.isDrawable()) {
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
  if (picture.isDiverged())
    particles.colors.assign(particles.points.size(), colorOf(kDivergedColor));
}

void drawAnchor(const Picture& picture, Marker& anchor) {
  setScale(anchor, 1.5 * picture.diameter());
  anchor.scale.y = 0.01 * picture.diameter();  // flat: its underside would be black
  anchor.color = colorOf(kHeldColor);
  if (picture.run.isFinite())
    anchor.pose.position = pointOf(picture.run.state(), 0, -picture.depth());
}

}  // namespace spring_pendulum

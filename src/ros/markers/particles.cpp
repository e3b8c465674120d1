#include "ros/markers/picture.hpp"
#include "ros/parameters/color.hpp"

namespace spring_pendulum {

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
                                     ? lighter(*parseColor(picture.options.color))
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

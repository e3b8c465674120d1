#include "ros/markers/picture.hpp"
#include "ros/parameters/color.hpp"

namespace spring_pendulum {
namespace {

constexpr double kDepth = 0.015;  ///< behind the chain, in sizes of the picture, to avoid flicker

}  // namespace

void drawReference(const Picture& picture, Marker& reference) {
  const State* state = picture.options.show_reference ? picture.run.referenceState() : nullptr;
  setScale(reference, picture.width());
  reference.color.a = 0.4F;
  reference.points.clear();
  if (state == nullptr || state->size() != picture.run.state().size() ||
      !state->values().allFinite()) {
    return;
  }
  for (std::size_t n = 1; n < picture.drawn.size(); ++n) {
    for (const Eigen::Index end : {picture.drawn[n - 1], picture.drawn[n]}) {
      reference.points.push_back(pointOf(*state, end, kDepth * picture.view.size()));
    }
  }
}

}  // namespace spring_pendulum

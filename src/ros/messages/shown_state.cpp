#include "ros/messages/shown_state.hpp"

#include <utility>

namespace spring_pendulum {

void ShownState::set(const Run& run, double share) {
  if (last_.size() != run.state().size() || run.time() < last_time_) {
    before_ = run.state();  // first state, or state after a reset
    before_time_ = run.time();
  } else if (run.time() > last_time_) {
    std::swap(before_, last_);
    before_time_ = last_time_;
  }
  last_ = run.state();
  last_time_ = time_ = run.time();
  between_ = share < 1.0 && before_time_ < last_time_ && run.isFinite() && run.isShown();
  if (between_) interpolate(share);
}

void ShownState::interpolate(double share) {
  const double interval = last_time_ - before_time_;
  const double rest = 1.0 - share;
  const double before_weight = rest * rest * (1.0 + 2.0 * share);
  const double last_weight = share * share * (3.0 - 2.0 * share);
  const double before_slope = share * rest * rest * interval;
  const double last_slope = -share * share * rest * interval;
  shown_ = last_;
  shown_.x() = before_weight * before_.x() + last_weight * last_.x() + before_slope * before_.vx() +
               last_slope * last_.vx();
  shown_.y() = before_weight * before_.y() + last_weight * last_.y() + before_slope * before_.vy() +
               last_slope * last_.vy();
  time_ = before_time_ + share * interval;
}

}  // namespace spring_pendulum

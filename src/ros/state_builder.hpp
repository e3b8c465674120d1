// One state of a run as the message of the topic `state`.
#pragma once

#include "ros/pendulum_run.hpp"
#include <spring_pendulum/PendulumState.h>

#include <std_msgs/Header.h>

namespace spring_pendulum {

/// Sets the four fields that `state` and `status` have for the position error.
template <typename Message>
void setPositionError(const PendulumRun& run, Message& message) {
  const PositionError error = run.positionError();
  message.position_error = error.now;
  message.largest_position_error = error.largest;
  message.largest_position_error_time = error.largest_time;
  message.position_error_measured_until = error.measured_until;
}

class StateBuilder {
 public:
  /// \param y_offset m, where the plane of the motion lies
  explicit StateBuilder(double y_offset) : y_offset_(y_offset) {}

  /// \return valid until the next call
  const PendulumState& build(const PendulumRun& run, const std_msgs::Header& header);

 private:
  void copyState(const State& state);

  double y_offset_;
  PendulumState message_;  ///< kept, so that its arrays are allocated once
};

/// Largest length of a spring in rest lengths, less 1; in m if the springs have no rest length.
double largestStretch(const Chain& chain, const State& state);

}  // namespace spring_pendulum

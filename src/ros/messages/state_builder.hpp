// Builds the message of the topic `state`.
#pragma once

#include <spring_pendulum/PendulumState.h>
#include <spring_pendulum/simulation/run.hpp>

#include <std_msgs/Header.h>

namespace spring_pendulum {

/// Sets the four fields for the position error of the messages `state` and `status`.
template <typename Message>
void setPositionError(const Run& run, Message& message) {
  const PositionError error = run.positionError();
  message.position_error = error.now;
  message.largest_position_error = error.largest;
  message.largest_position_error_time = error.largest_time;
  message.position_error_measured_until = error.measured_until;
}

class StateBuilder {
 public:
  /// \param y_offset y of the plane of the motion, m
  explicit StateBuilder(double y_offset) : y_offset_(y_offset) {}

  /// \returns a reference that is valid until the next call
  const PendulumState& build(const Run& run, const std_msgs::Header& header);

 private:
  void copyState(const State& state);

  double y_offset_;
  PendulumState message_;  ///< kept, so that its arrays are allocated once
};

/// Returns the strain of a spring, length/rest length - 1, or its length in m if the rest length is
/// 0.
double strainOf(double length, double rest_length);

/// Returns the largest strain of all springs; 0 without springs.
double largestStretch(const Chain& chain, const State& state);

}  // namespace spring_pendulum

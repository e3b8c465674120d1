#include "ros/messages/state_builder.hpp"

#include <spring_pendulum/model/dynamics.hpp>

#include <cmath>
#include <limits>

namespace spring_pendulum {

double strainOf(double length, double rest_length) {
  return rest_length > 0.0 ? length / rest_length - 1.0 : length;
}

namespace {

/// Force of spring i along its direction, N.
double tension(const Chain& chain, const State& state, Eigen::Index i) {
  const double length = springLength(state, i);
  if (length == 0.0) return 0.0;
  const PlaneVector<double> force = springForceOn(chain, state, i);
  return (force.x * (state.x()[i + 1] - state.x()[i]) +
          force.y * (state.y()[i + 1] - state.y()[i])) /
         length;
}

}  // namespace

double largestStretch(const Chain& chain, const State& state) {
  if (state.size() < 2) return 0.0;
  double longest = 0.0;
  for (Eigen::Index i = 0; i + 1 < state.size(); ++i) {
    longest = std::max(longest, springLength(state, i));
  }
  return strainOf(longest, chain.spring().rest_length);
}

const PendulumState& StateBuilder::build(const Run& run, const std_msgs::Header& header) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const EnergyEntry entry = run.energyEntry();
  message_.header = header;
  message_.method = run.scenario().method.get().name;
  message_.frame = run.frame();
  message_.at_frame = run.isAtFrame() ? 1 : 0;
  message_.time = run.time();
  message_.kinetic_energy = entry.energy.kinetic;
  message_.gravity_energy = entry.energy.gravity;
  message_.spring_energy = entry.energy.spring;
  message_.dissipated_energy = entry.dissipated.value_or(kUnknown);
  message_.total_energy = entry.energy.total() + message_.dissipated_energy;
  message_.energy_error = entry.relative_residual.value_or(kUnknown);
  setPositionError(run, message_);
  message_.largest_stretch = largestStretch(run.chain(), run.state());
  message_.verdict = std::string(toString(run.verdict().kind));
  message_.supplied_energy = entry.supplied;
  copyState(run.state());
  message_.tensions.resize(message_.positions.size() - 1);
  for (std::size_t i = 0; i < message_.tensions.size(); ++i) {
    message_.tensions[i] = tension(run.chain(), run.state(), static_cast<Eigen::Index>(i));
  }
  message_.tip_position = message_.positions.back();
  const geometry_msgs::Vector3& tip_velocity = message_.velocities.back();
  message_.tip_speed = std::hypot(tip_velocity.x, tip_velocity.z);
  return message_;
}

void StateBuilder::copyState(const State& state) {
  const auto particles = static_cast<std::size_t>(state.size());
  message_.positions.resize(particles);
  message_.velocities.resize(particles);
  for (std::size_t n = 0; n < particles; ++n) {
    const auto i = static_cast<Eigen::Index>(n);
    message_.positions[n].x = state.x()[i];
    message_.positions[n].y = y_offset_;
    message_.positions[n].z = state.y()[i];
    message_.velocities[n].x = state.vx()[i];
    message_.velocities[n].z = state.vy()[i];
  }
}

}  // namespace spring_pendulum

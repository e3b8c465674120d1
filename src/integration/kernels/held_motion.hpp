// The prescribed motion of the held particles of a driven chain.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <vector>

namespace spring_pendulum {

/// Puts held particles where they belong: a method need not integrate a constant acceleration exactly.
/// P_1 of a chain that is not driven is at rest. Under a drive without an entry for it, it keeps its velocity.
class HeldMotion {
 public:
  explicit HeldMotion(const Chain& chain) {
    if (!chain.isDriven()) return;
    for (Eigen::Index i = 0; i < chain.size(); ++i)
      if (chain.isHeld(i)) held_.push_back({i, chain.springlessAcceleration(i)});
  }

  void restart() { started_ = false; }

  /// Called with the state before steps of this size.
  void begin(State& state, double time_step) {
    if (held_.empty()) state.velocities().row(0).setZero();
    if (!started_) {
      for (auto& [i, a, start] : held_)
        for (Eigen::Index c = 0; c < 4; ++c) start[c] = state.values()(i, c);
      origin_ = time_step_ = 0.0;
      steps_ = 0;
      started_ = true;
    }
    if (time_step == time_step_) return;
    origin_ = time();
    steps_ = 0;
    time_step_ = time_step;
  }

  /// Called with the values of a state after each number of steps.
  template <typename Values>
  void place(Values&& z, std::int64_t steps) {
    steps_ += steps;
    const double t = time();
    for (const auto& [i, a, start] : held_) {
      z(i, 0) = fused(t, fused(0.5 * t, a.x, start[2]), start[0]);
      z(i, 1) = fused(t, fused(0.5 * t, a.y, start[3]), start[1]);
      z(i, 2) = fused(t, a.x, start[2]);
      z(i, 3) = fused(t, a.y, start[3]);
    }
  }

 private:
  struct Held {
    Eigen::Index particle;
    PlaneVector<double> acceleration;  ///< m/s²
    double start[4] = {};              ///< x, y, vx, vy
  };
  double time() const { return origin_ + static_cast<double>(steps_) * time_step_; }

  std::vector<Held> held_;
  bool started_ = false;
  double origin_ = 0.0;     ///< time of the first step of `time_step_`, s
  double time_step_ = 0.0;  ///< s
  std::int64_t steps_ = 0;
};

}  // namespace spring_pendulum

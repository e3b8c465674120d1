// The state that the markers show: the state of the run, or in slow motion one between the last
// two.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

namespace spring_pendulum {

class ShownState {
 public:
  /// Sets the state from the state of the run.
  /// \param share 1 for the state of the run; less for a state interpolated between the previous
  ///   state (0) and the current one, with cubic Hermite polynomials
  void set(const Run& run, double share = 1.0);

  const State& state() const { return between_ ? shown_ : last_; }
  double time() const { return time_; }  ///< s, simulated

 private:
  void interpolate(double share);

  State before_;
  State last_;
  State shown_;
  bool between_ = false;
  double before_time_ = 0.0;
  double last_time_ = 0.0;
  double time_ = 0.0;
};

}  // namespace spring_pendulum

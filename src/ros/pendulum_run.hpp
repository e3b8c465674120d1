// One run as it is shown: from frame to frame, with states between the frames for smooth motion.
//
// A frame of n steps is cut into parts of whole steps (fixed-step methods), or into 2^q equal parts
// at which an error-controlled method is evaluated as well. Both leave the bits of the frames as
// they are, so the frame files are those of Exercise3.
#pragma once

#include "io/run_files.hpp"
#include "simulation/run_monitor.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <memory>

namespace spring_pendulum {

class PendulumRun {
 public:
  /// \param display_interval simulated time in s from one state shown to the next; 0: frames only
  /// \throws InputError as Chain, makeIntegrator and Judge
  PendulumRun(const Scenario& scenario, const Particles& particles, bool track_energy,
              double display_interval);

  /// On to the end of the frame's current part, or to the next frame.
  /// \throws Interrupted after a signal; then the run can only be ended
  void advance(bool in_between);
  /// Back to frame 0. The verdict starts anew.
  void reset();

  /// The last frame is reached, or the motion diverged and is not carried on.
  bool isOver() const { return frame_ >= scenario_.frames - 1 || !isShown(); }
  /// Whether the frame reached may be shown and written: not if the motion diverged, unless
  /// `on_divergence` says so and its energy is finite.
  bool isShown() const { return monitor_.isShown(); }
  bool atFrame() const { return part_ == 0; }
  /// Whether every number of the state can be shown.
  bool isFinite() const { return state_.values().allFinite(); }

  const Scenario& scenario() const { return scenario_; }
  const Chain& chain() const { return chain_; }
  const Integrator& integrator() const { return *integrator_; }
  const State& state() const { return state_; }
  const State& start() const { return start_; }
  /// The verdict on the run so far.
  const Verdict& verdict() const { return monitor_.verdict(); }
  /// The energy balance's row of the current state.
  EnergyEntry energyEntry() const;
  /// Position error of the current state, and the largest one at the frames so far.
  PositionError positionError() const;
  /// The true state as the reference run has it, at the time of `state()`; null where none runs.
  const State* referenceState() const;
  /// Position and energy error in words, and a tolerance that was not kept; see RunMonitor.
  std::string measurements() const { return monitor_.measurements(); }
  std::string toleranceRemark() const { return monitor_.toleranceRemark(); }

  /// Hands the frame to the files if the run stands at one that may be shown, and closes them after
  /// the last one.
  void writeTo(RunFiles& files) const;

  std::int64_t frame() const { return frame_; }
  /// Steps taken since frame 0; frames for an error-controlled method.
  std::int64_t steps() const;
  /// Simulated time, s.
  double time() const { return timeOfPart(part_); }
  /// Simulated time of the state that `advance(true)` leads to, s.
  double nextTime() const { return timeOfPart(part_ + 1); }

 private:
  std::int64_t stepOfPart(std::int64_t part) const;
  double timeOfPart(std::int64_t part) const;
  void judgeFrame();

  Scenario scenario_;
  Chain chain_;
  State start_;
  State state_;
  FrameSteps frame_steps_;  ///< refined for an error-controlled method
  std::int64_t parts_ = 1;  ///< of a frame
  RunMonitor monitor_;
  std::unique_ptr<Integrator> integrator_;
  std::int64_t frame_ = 0;  ///< last frame reached
  std::int64_t part_ = 0;   ///< parts of the next frame that are done
};

}  // namespace spring_pendulum

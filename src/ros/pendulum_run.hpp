// A run for display: frame by frame, with states between the frames for smooth motion.
//
// A frame of n steps is divided into parts of whole steps (fixed-step methods) or into 2^q equal
// output intervals (error-controlled methods). Neither changes the bits of the frames, so the frame
// files are the same as those of Exercise3.
#pragma once

#include "io/formats/run_files.hpp"
#include "simulation/run_monitor.hpp"
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <memory>

namespace spring_pendulum {

class PendulumRun {
 public:
  /// \param display_interval simulated time in s between shown states; 0: frames only
  /// \throws InputError as Chain, makeIntegrator and Judge
  PendulumRun(const Scenario& scenario, const Particles& particles, bool track_energy,
              double display_interval);

  /// Advances to the end of the current part of the frame, or to the next frame.
  /// \throws Interrupted after a signal; the run can't continue then
  void advance(bool in_between);
  /// Returns to frame 0 and discards the verdict.
  void reset();

  /// Whether the last frame is reached, or the motion diverged and the run does not continue.
  bool isOver() const { return frame_ >= scenario_.frames - 1 || !isShown(); }
  /// Whether the current frame may be shown and written; see RunMonitor.
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
  /// The energy balance of the current state.
  EnergyEntry energyEntry() const;
  /// Position error of the current state, and the largest one at the frames so far.
  PositionError positionError() const;
  /// The state of the reference run at the time of `state()`; null if there is none.
  const State* referenceState() const;
  /// See RunMonitor.
  std::string measurements() const { return monitor_.measurements(); }
  std::string toleranceRemark() const { return monitor_.toleranceRemark(); }

  /// Writes the current frame if it may be shown, and closes the files after the last frame.
  void writeTo(RunFiles& files) const;

  std::int64_t frame() const { return frame_; }
  /// Steps taken since frame 0; frames for an error-controlled method.
  std::int64_t steps() const;
  /// Simulated time, s.
  double time() const { return timeOfPart(part_); }
  /// Simulated time after `advance(true)`, s.
  double nextTime() const { return timeOfPart(part_ + 1); }

 private:
  std::int64_t stepOfPart(std::int64_t part) const;
  double timeOfPart(std::int64_t part) const;
  void judgeFrame();

  Scenario scenario_;
  Chain chain_;
  State start_;
  State state_;
  FrameSteps frame_steps_;  ///< with shorter steps for an error-controlled method
  std::int64_t parts_ = 1;  ///< per frame
  RunMonitor monitor_;
  std::unique_ptr<Integrator> integrator_;
  std::int64_t frame_ = 0;  ///< last frame
  std::int64_t part_ = 0;   ///< completed parts of the next frame
};

}  // namespace spring_pendulum

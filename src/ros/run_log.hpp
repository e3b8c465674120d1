// What a node says about its run on /rosout and the screen, at the moment when it happens.
#pragma once

#include "io/run_files.hpp"
#include "ros/pendulum_run.hpp"
#include "ros/publisher.hpp"

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// Work done since the node started; a reset does not take it back.
struct Totals {
  std::int64_t frames = 1;
  std::int64_t steps = 0;
  double seconds = 0.0;  ///< integrating
};

/// One line: frames, steps, force evaluations, times, position and energy error, verdict.
std::string closingLine(const PendulumRun& run, const Totals& totals, const RunFiles& files,
                        const Publisher& publisher);

class RunLog {
 public:
  /// Says what will be run, warns of a time step that is too large, and says at INFO that the display
  /// rate is above the number of states.
  void start(const PendulumRun& run, const NodeOptions& options, const RunFiles& files);

  /// To be called after every action. Says once each: a bad verdict, the divergence with what to
  /// do about it, what Auto chose, the end of the run.
  void follow(const PendulumRun& run, const Totals& totals, const RunFiles& files,
              const Publisher& publisher);

  /// Says the closing line of a run that did not reach its end, or went on after it.
  void finish(const PendulumRun& run, const Totals& totals, const RunFiles& files,
              const Publisher& publisher);

 private:
  void sayChoice(const PendulumRun& run);

  VerdictKind said_verdict_ = VerdictKind::kOk;
  std::int64_t said_frames_ = 0;  ///< frames when the closing line was said; 0: not yet
  std::string said_choice_;
  bool said_tolerance_ = false;
  int choices_said_ = 0;
  bool holds_ = false;  ///< the node lives on at the end of the run
};

}  // namespace spring_pendulum

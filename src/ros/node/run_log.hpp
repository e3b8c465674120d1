// The log messages of a node about its run.
#pragma once

#include "io/formats/run_files.hpp"
#include "ros/node/publisher.hpp"
#include "ros/pendulum_run.hpp"

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// Work since the start of the node, including that before a reset.
struct Totals {
  std::int64_t frames = 1;
  std::int64_t steps = 0;
  double seconds = 0.0;  ///< time spent integrating
};

/// Returns a line with frames, steps, force evaluations, times, position and energy error, verdict.
std::string closingLine(const PendulumRun& run, const Totals& totals, const RunFiles& files,
                        const Publisher& publisher);

/// Log one line. Once ROS has shut down, its log no longer prints: then on standard error.
void logInfo(const std::string& text);
void logFatal(const std::string& text);

class RunLog {
 public:
  /// Logs the run, a warning if the time step is too large, and a display rate above the number of
  /// states.
  void start(const PendulumRun& run, const NodeOptions& options, const RunFiles& files);

  /// Must be called after every action. Logs once each: a bad verdict, a divergence with its
  /// remedy, the choices of Auto, the end of the run.
  void follow(const PendulumRun& run, const Totals& totals, const RunFiles& files,
              const Publisher& publisher);

  /// Logs the closing line of a run that did not reach its end, or continued after it.
  void finish(const PendulumRun& run, const Totals& totals, const RunFiles& files,
              const Publisher& publisher) const;

 private:
  void sayChoice(const PendulumRun& run);

  VerdictKind said_verdict_ = VerdictKind::kOk;
  std::int64_t said_frames_ = 0;  ///< number of frames at the closing line; 0: not logged yet
  std::string said_choice_;
  bool said_tolerance_ = false;
  int choices_said_ = 0;
  bool holds_ = false;  ///< whether the node continues after the end of the run
};

}  // namespace spring_pendulum

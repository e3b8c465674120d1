// The log messages of a node about its run.
#pragma once

#include "ros/node/publisher.hpp"
#include <spring_pendulum/io/run_files.hpp>
#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <memory>
#include <string>

namespace spring_pendulum {

/// Log one line. Once ROS has shut down, its log no longer prints: then on standard error.
void logInfo(const std::string& text);
void logFatal(const std::string& text);

/// Logs the run, a warning if the time step is too large, and a display rate above the number of
/// states.
void logStart(const Run& run, const Scenario& scenario, const NodeOptions& options,
              const RunFiles& files);

class RunLog {
 public:
  /// All but `continues` must outlive the log.
  /// \param continues whether the node continues after the end of the run
  RunLog(const Run& run, const RunFiles& files, const Publisher& publisher, bool continues)
      : run_(run), files_(files), publisher_(publisher), continues_(continues) {}

  /// Must be called after every action. Logs once each: a bad verdict, a divergence with its
  /// remedy, the choices of Auto, the end of the run.
  void update();

  /// Logs the closing line of a run that did not reach its end, or continued after it.
  void finish() const;

 private:
  std::string closingLine() const;

  const Run& run_;
  const RunFiles& files_;
  const Publisher& publisher_;
  bool continues_;
  VerdictKind said_verdict_ = VerdictKind::kOk;
  std::int64_t last_frame_ = 0;   ///< at the last action
  std::int64_t said_frames_ = 0;  ///< number of frames at the closing line; 0: not logged yet
  std::string said_tolerance_;
};

}  // namespace spring_pendulum

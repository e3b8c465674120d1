#include "ros/node/run_log.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/program/program.hpp"
#include <spring_pendulum/simulation/outcome.hpp>

#include <fmt/format.h>

#include <ros/console.h>
#include <ros/init.h>

#include <utility>

namespace spring_pendulum {
namespace {

/// Whether lines logged with ROS still appear.
bool rosLogs() {
  return ros::ok() && !ros::isShuttingDown();
}

}  // namespace

void logInfo(const std::string& text) {
  if (rosLogs()) {
    ROS_INFO_STREAM(text);
  } else {
    printError("[ INFO]: " + text + "\n");
  }
}

void logFatal(const std::string& text) {
  if (rosLogs()) {
    ROS_FATAL_STREAM(text);
  } else {
    printError("[FATAL]: " + text + "\n");
  }
}

void logStart(const Run& run, const Scenario& scenario, const NodeOptions& options,
              const RunFiles& files) {
  ROS_INFO_STREAM(scenario.method.get().name << " on " << fullPath(scenario.particles) << ", "
                                             << files.description());
  const Remarks remarks = remarksOn(run);
  if (!remarks.warning.empty()) ROS_WARN_STREAM(remarks.warning);
  for (const std::string& note : remarks.notes) ROS_INFO_STREAM(note);
  if (!options.follow.empty()) {
    ROS_INFO_STREAM(scenario.method.get().name << ": waiting for states of another node on "
                                               << options.follow << " (follow)");
  }
}

std::string RunLog::closingLine() const {
  return run_.closingLine(fmt::format("{}, {}", files_.closingText(), publisher_.numbers()));
}

void RunLog::update() {
  if (continues_ && run_.frame() < last_frame_) {  // after a reset
    said_verdict_ = VerdictKind::kOk;
    said_frames_ = 0;
    said_tolerance_.clear();
  }
  last_frame_ = run_.frame();
  const Verdict& verdict = run_.verdict();
  const std::string& method = run_.plan().method.get().name;
  if (verdict.kind > said_verdict_) {
    said_verdict_ = verdict.kind;
    if (verdict.kind == VerdictKind::kDiverged) {
      ROS_ERROR_STREAM(method << ": " << outcomeOf(run_, interruption).lines.front()
                              << (run_.isChanged() ? "; call ~reset to start again" : ""));
    } else if (verdict.kind != VerdictKind::kNotChecked) {
      ROS_WARN_STREAM(method << ": " << verdict.text);
    }
  }
  if (std::string remark = run_.toleranceRemark(); remark.size() > said_tolerance_.size()) {
    ROS_WARN_STREAM(method << ": " << remark);
    said_tolerance_ = std::move(remark);
  }
  if (!run_.isOver() || said_frames_ != 0) return;
  said_frames_ = run_.shownFrames();
  ROS_INFO_STREAM(closingLine());
  if (continues_) {
    ROS_INFO_STREAM(method << ": the last frame stays shown until Ctrl-C (at_end: hold)");
  }
}

void RunLog::finish() const {
  if (said_frames_ == run_.shownFrames()) return;
  logInfo(closingLine());
}

}  // namespace spring_pendulum

// The log messages of a node about its run.
#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/program/program.hpp"
#include "ros/node/node.hpp"
#include <spring_pendulum/simulation/outcome.hpp>

#include <fmt/format.h>

#include <ros/console.h>
#include <ros/init.h>

namespace spring_pendulum {
namespace {

/// Whether lines logged with ROS still appear.
bool rosLogs() {
  return ros::ok() && !ros::isShuttingDown();
}

}  // namespace

void logInfo(const std::string& text) {
  if (!rosLogs()) return printError("[ INFO]: " + text + "\n");
  ROS_INFO_STREAM(text);
}

void logFatal(const std::string& text) {
  if (!rosLogs()) return printError("[FATAL]: " + text + "\n");
  ROS_FATAL_STREAM(text);
}

void Node::logStart() const {
  const std::string& method = run_.plan().method.get().name;
  ROS_INFO_STREAM(method << " on " << fullPath(scenario_.particles) << ", "
                         << files_.description());
  const Remarks remarks = remarksOn(run_);
  if (!remarks.warning.empty()) ROS_WARN_STREAM(remarks.warning);
  for (const std::string& note : remarks.notes) ROS_INFO_STREAM(note);
}

std::string Node::closingLine() const {
  return run_.closingLine(fmt::format("{}, {}", files_.closingText(), publisher_.numbers()));
}

void Node::logChanges() {
  const Verdict& verdict = run_.verdict();
  const std::string& method = run_.plan().method.get().name;
  if (verdict.kind > logged_.verdict) {
    logged_.verdict = verdict.kind;
    if (verdict.kind == VerdictKind::kDiverged) {
      ROS_ERROR_STREAM(method << ": " << outcomeOf(run_, interruption).lines.front()
                              << (run_.isChanged() ? "; call ~reset to start again" : ""));
    } else if (verdict.kind != VerdictKind::kNotChecked) {
      ROS_WARN_STREAM(method << ": " << verdict.text);
    }
  }
  if (std::string remark = run_.toleranceRemark();
      remark.size() > logged_.tolerance_remark.size()) {
    ROS_WARN_STREAM(method << ": " << remark);
    logged_.tolerance_remark = std::move(remark);
  }
  if (!run_.isOver() || logged_.frames != 0) return;
  logged_.frames = run_.shownFrames();
  ROS_INFO_STREAM(closingLine());
  if (options_.at_end == AtEnd::kHold) {
    ROS_INFO_STREAM(method << ": the last frame stays shown until Ctrl-C (at_end: hold)");
  }
}

}  // namespace spring_pendulum

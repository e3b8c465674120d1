#include "ros/messages/run_messages.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

namespace spring_pendulum {
namespace {

PendulumStatus statusOf(const Run& run, bool paused) {
  PendulumStatus status;
  const Verdict& verdict = run.verdict();
  setPositionError(run, status);
  if (!run.isShown()) {
    status.code = PendulumStatus::DIVERGED;
    status.text = verdict.text;
    return status;
  }
  if (run.isOver()) {
    status.code = PendulumStatus::FINISHED;
    status.text = fmt::format("finished: {}, {:.6g} s, {}", counted(run.frame() + 1, "frame"),
                              run.time(), run.measurements());
  } else if (paused) {
    status.code = PendulumStatus::PAUSED;
    status.text = fmt::format("paused at frame {}, t = {:.6g} s", run.frame(), run.time());
  } else {
    status.code = PendulumStatus::RUNNING;
    status.text =
        fmt::format("running, {} to t = {:.6g} s", counted(run.scenario().frames, "frame"),
                    frameSteps(run.scenario()).timeOfFrame(run.scenario().frames - 1));
  }
  status.text += ", verdict: " + verdict.text;
  return status;
}

}  // namespace

RunMessages::RunMessages(const Run& run, const NodeOptions& options, bool simulated)
    : frame_id_(options.frame_id),
      has_camera_(!options.camera_frame.empty()),
      stamps_(simulated),
      markers_(run, options),
      state_(options.y_offset) {
  const Scenario& scenario = run.scenario();
  if (simulated) Stamps(true).next(frameSteps(scenario).timeOfFrame(scenario.frames - 1));
}

std_msgs::Header RunMessages::header(double simulated_time) {
  std_msgs::Header header;
  header.frame_id = frame_id_;
  header.stamp = stamps_.next(simulated_time);
  return header;
}

std::optional<tf2_msgs::TFMessage> RunMessages::newCamera(const std_msgs::Header& header) {
  if (!has_camera_ || markers_.cameraChanges() == camera_changes_) return std::nullopt;
  camera_changes_ = markers_.cameraChanges();
  tf2_msgs::TFMessage message;
  message.transforms = {markers_.camera(header)};
  return message;
}

std::optional<PendulumStatus> RunMessages::newStatus(const Run& run, bool paused) {
  PendulumStatus status = statusOf(run, paused);
  if (status.text == last_status_) return std::nullopt;
  last_status_ = status.text;
  return status;
}

}  // namespace spring_pendulum

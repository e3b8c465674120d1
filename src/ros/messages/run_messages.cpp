#include "ros/messages/run_messages.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

/// Sets the four fields for the position error of the messages `state` and `status`.
template <typename Message>
void setPositionError(Message& message, const PositionError& error) {
  message.position_error = error.now;
  message.largest_position_error = error.largest;
  message.largest_position_error_time = error.largest_time;
  message.position_error_measured_until = error.measured_until;
}

void setParticles(PendulumState& message, const State& state) {
  const auto particles = static_cast<std::size_t>(state.size());
  message.positions.resize(particles);
  message.velocities.resize(particles);
  for (std::size_t n = 0; n < particles; ++n) {
    const auto i = static_cast<Eigen::Index>(n);
    message.positions[n] = pointOf(state, i);
    message.velocities[n].x = state.vx()[i];
    message.velocities[n].z = state.vy()[i];
  }
}

/// Sets the tensions and the largest stretch.
void setSprings(PendulumState& message, const Chain& chain, const State& state) {
  double longest = 0.0;
  message.tensions.resize(static_cast<std::size_t>(state.size() - 1));
  for (Eigen::Index i = 0; i + 1 < state.size(); ++i) {
    const double length = springLength(state, i);
    const PlaneVector<double> force = springForceOn(chain, state, i);  // 0 without a direction
    const double along =
        force.x * (state.x()[i + 1] - state.x()[i]) + force.y * (state.y()[i + 1] - state.y()[i]);
    message.tensions[static_cast<std::size_t>(i)] = length > 0.0 ? along / length : 0.0;
    longest = std::max(longest, length);
  }
  message.largest_stretch = state.size() > 1 ? strainOf(longest, chain.spring().rest_length) : 0.0;
}

PendulumStatus statusOf(const Run& run, bool paused) {
  PendulumStatus status;
  const Verdict& verdict = run.verdict();
  setPositionError(status, run.positionError());
  if (!run.isShown()) {
    status.code = PendulumStatus::DIVERGED;
    status.text = verdict.text;
  } else if (run.isOver()) {
    status.code = PendulumStatus::FINISHED;
    status.text = fmt::format("finished: {}, {:.6g} s, {}", counted(run.frame() + 1, "frame"),
                              run.time(), run.measurements());
  } else if (paused) {
    status.code = PendulumStatus::PAUSED;
    status.text = fmt::format("paused at frame {}, t = {:.6g} s", run.frame(), run.time());
  } else {
    status.code = PendulumStatus::RUNNING;
    status.text = fmt::format("running, {} to t = {:.6g} s", counted(run.plan().frames, "frame"),
                              run.plan().timeOfFrame(run.plan().frames - 1));
  }
  if (run.isShown()) status.text += ", verdict: " + verdict.text;
  return status;
}

struct Kind {
  const char* name;  ///< namespace of the marker
  int type;
  void (*draw)(const Picture&, Marker&);
};

constexpr Kind kKinds[] = {{"springs", Marker::LINE_LIST, drawSprings},
                           {"particles", Marker::SPHERE_LIST, drawParticles},
                           {"anchor", Marker::CUBE, drawAnchor},
                           {"text", Marker::TEXT_VIEW_FACING, drawText},
                           {"grid", Marker::LINE_LIST, drawGrid}};

}  // namespace

void setState(PendulumState& message, const Run& run, const std_msgs::Header& header) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const EnergyEntry entry = run.energyEntry();
  message.header = header;
  message.method = run.plan().method.get().name;
  message.frame = run.frame();
  message.at_frame = run.isAtFrame() ? 1 : 0;
  message.time = run.time();
  message.kinetic_energy = entry.energy.kinetic;
  message.gravity_energy = entry.energy.gravity;
  message.spring_energy = entry.energy.spring;
  message.dissipated_energy = entry.dissipated.value_or(kUnknown);
  message.total_energy = entry.energy.total() + message.dissipated_energy;
  message.energy_error = entry.relative_residual.value_or(kUnknown);
  message.supplied_energy = entry.supplied;
  message.verdict = std::string(toString(run.verdict().kind));
  setPositionError(message, run.positionError());
  setParticles(message, run.state());
  setSprings(message, run.chain(), run.state());
  message.tip_position = message.positions.back();
  message.tip_speed = std::hypot(message.velocities.back().x, message.velocities.back().z);
}

RunMessages::RunMessages(const Run& run, const NodeOptions& options, bool simulated)
    : options_(options),
      stamps_(simulated),
      drawn_(evenlyChosen(run.chain().size(), options.display_limit)),
      view_(run, options.held.empty()),
      camera_moved_(!options.camera_frame.empty() && options.text_row <= 1) {
  const Plan& plan = run.plan();
  if (simulated) Stamps(true).next(plan.timeOfFrame(plan.frames - 1));
  for (const Kind& kind : kKinds) {
    Marker& marker = markers_.markers.emplace_back();
    marker.ns = kind.name;
    marker.type = kind.type;
    marker.pose.orientation.w = 1.0;
    marker.color = colorOf(0xe6e9ee);  // of the text
  }
}

std_msgs::Header RunMessages::header(double simulated_time) {
  std_msgs::Header header;
  header.frame_id = options_.frame_id;
  header.stamp = stamps_.next(simulated_time);
  return header;
}

void RunMessages::draw(const Run& run, const std_msgs::Header& header, bool same_camera) {
  const Picture picture{run, options_, view_, drawn_};
  // The other chains keep to the view of the first one.
  if (run.isFinite() && run.isShown() && options_.text_row <= 1 && !same_camera &&
      view_.widenFor(run.state()))
    camera_moved_ = !options_.camera_frame.empty();
  for (std::size_t i = 0; i < markers_.markers.size(); ++i) {
    Marker& marker = markers_.markers[i];
    marker.header = header;
    kKinds[i].draw(picture, marker);
    if (run.verdict().kind == VerdictKind::kDiverged)
      std::fill(marker.colors.begin(), marker.colors.end(), colorOf(kDivergedColor));
    // rviz reports an error for a list without points
    const bool is_list = marker.type == Marker::LINE_LIST || marker.type == Marker::SPHERE_LIST;
    marker.action = is_list && marker.points.size() < 2 ? Marker::DELETE : Marker::ADD;
  }
}

tf2_msgs::TFMessage RunMessages::camera(const std_msgs::Header& header) const {
  tf2_msgs::TFMessage message;
  auto& camera = message.transforms.emplace_back();
  camera.header = header;
  camera.child_frame_id = options_.camera_frame;
  camera.transform.translation.x = view_.box.center().x();
  camera.transform.translation.y = -view_.cameraDistance();
  camera.transform.translation.z = view_.cameraHeight();
  // Rotation by 90 degrees about z: the x axis of the camera, its viewing direction, is the y axis.
  camera.transform.rotation.z = camera.transform.rotation.w = std::sqrt(0.5);
  return message;
}

std::optional<StateMessages> RunMessages::build(const Run& run, const Showing& showing) {
  PendulumStatus status = statusOf(run, showing.paused);
  const bool has_changed = status.text != last_status_;
  if (!showing.due && !has_changed) return std::nullopt;
  StateMessages messages;
  messages.header = header(run.time());
  if (showing.wants_markers) {
    draw(run, messages.header, showing.same_camera);
    messages.markers = &markers_;
    if (std::exchange(camera_moved_, false)) messages.camera = camera(messages.header);
  }
  if (showing.wants_state) {
    setState(state_, run, messages.header);
    messages.state = &state_;
  }
  if (has_changed) {
    last_status_ = status.text;
    status.header = messages.header;
    messages.status = std::move(status);
  }
  return messages;
}

}  // namespace spring_pendulum

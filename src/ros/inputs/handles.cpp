#include "ros/inputs/handles.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>

#include <fmt/format.h>

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

using interactive_markers::MenuHandler;
using visualization_msgs::InteractiveMarkerFeedback;

constexpr double kLongestSilence = 1.0;  // s
/// Diameter of a handle, in lengths of the chain at the start; smaller if handles are close together.
constexpr double kSize = 0.08;
constexpr double kShareOfSpring = 0.7;

std::string nameOf(std::ptrdiff_t particle) {
  return fmt::format("particle_{}", particle + 1);
}

visualization_msgs::InteractiveMarkerControl movingControl() {
  visualization_msgs::InteractiveMarkerControl control;
  control.name = "move";
  control.always_visible = 1;
  control.interaction_mode = visualization_msgs::InteractiveMarkerControl::MOVE_PLANE;
  // The plane is perpendicular to the x axis of the control: turned to the y axis of the frame.
  control.orientation.w = control.orientation.z = std::sqrt(0.5);
  control.orientation_mode = visualization_msgs::InteractiveMarkerControl::FIXED;
  visualization_msgs::Marker ball;
  ball.type = visualization_msgs::Marker::SPHERE;
  ball.pose.orientation.w = 1.0;
  ball.color.r = ball.color.g = ball.color.b = 1.0F;
  ball.color.a = 0.12F;
  control.markers.push_back(ball);
  return control;
}

}  // namespace

std::vector<std::ptrdiff_t> Handles::chosen(std::ptrdiff_t particles) {
  const auto count = std::min<std::ptrdiff_t>(particles, kMost);
  std::vector<std::ptrdiff_t> result;
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    result.push_back(count < 2 ? 0 : k * (particles - 1) / (count - 1));
  }
  return result;
}

Handles::Handles(ros::NodeHandle& node, const Run& run, const NodeOptions& options,
                 const Driver& driver, Frames& frames, RequestHandler take)
    : run_(run),
      driver_(driver),
      frames_(frames),
      take_(std::move(take)),
      frame_id_(options.frame_id),
      y_(options.y_offset),
      farthest_(10.0 * std::max(chainLength(run.chain(), run.start()), 1.0)),
      server_(node.resolveName("handles")),
      particles_(chosen(run.chain().size())),
      updates_(node.advertise<visualization_msgs::InteractiveMarkerUpdate>("handles/update", 100)) {
  const double length = std::max(chainLength(run.chain(), run.start()), 0.1);
  const auto count = static_cast<double>(particles_.size());
  makeMenu();
  for (const std::ptrdiff_t particle : particles_) {
    insert(particle, std::min(kSize * length, kShareOfSpring * length / count));
  }
  checkMenu();
  show();
  server_.applyChanges();
}

void Handles::insert(std::ptrdiff_t particle, double size) {
  visualization_msgs::InteractiveMarker marker;
  marker.header.frame_id = frame_id_;
  marker.name = nameOf(particle);
  marker.scale = static_cast<float>(size);
  marker.pose = poseOf(particle);
  marker.controls.push_back(movingControl());
  auto& scale = marker.controls.back().markers.back().scale;
  scale.x = scale.y = scale.z = size;
  server_.insert(marker, [this, particle](const Feedback& f) { onFeedback(particle, f); });
  menu_.apply(server_, marker.name);
}

void Handles::ask(const Request& request) {
  try {
    take_(request);
  } catch (const InputError& error) {
    ROS_WARN_STREAM(error.what());
  }
}

void Handles::addEntry(const std::string& title, std::function<Request(std::ptrdiff_t)> request) {
  menu_.insert(title, [this, request = std::move(request)](const Feedback& feedback) {
    for (const std::ptrdiff_t particle : particles_) {
      if (feedback->marker_name == nameOf(particle)) ask(request(particle));
    }
    checkMenu();
  });
}

void Handles::makeMenu() {
  addEntry("Pause or go on", [](std::ptrdiff_t) { return Pause{}; });
  addEntry("Step", [this](std::ptrdiff_t) {
    ask(Pause{true});
    return Step{};
  });
  addEntry("Reset", [](std::ptrdiff_t) { return Reset{}; });
  addEntry("Save state", [](std::ptrdiff_t) { return SaveState{}; });
  addEntry("Hold here", [](std::ptrdiff_t i) { return Hold{i, {}}; });
  addEntry("Release", [](std::ptrdiff_t i) { return Release{i}; });
  const Scenario& launched = run_.scenario();
  addSwitch("Damping", "damping", &Scenario::damping,
            launched.damping > 0.0 ? launched.damping : Scenario{}.damping);
  addSwitch("Gravity", "gravity", &Scenario::gravity,
            launched.gravity != 0.0 ? launched.gravity : Scenario{}.gravity);
  const Entry methods = menu_.insert("Method");
  for (const Method& method : methodTable()) {
    const Entry entry = menu_.insert(methods, method.name, [this, &method](const Feedback&) {
      ask(SetConstant{"method", method.name});
      checkMenu();
    });
    checks_[entry] = [this, &method] { return &driver_.wanted().method.get() == &method; };
  }
}

void Handles::addSwitch(const std::string& title, const std::string& name,
                        double Scenario::*constant, double on) {
  const Entry entry = menu_.insert(title, [this, name, constant, on](const Feedback&) {
    ask(SetConstant{name, numberText(driver_.wanted().*constant == 0.0 ? on : 0.0)});
    checkMenu();
  });
  checks_[entry] = [this, constant] { return driver_.wanted().*constant != 0.0; };
}

void Handles::checkMenu() {
  if (!drags_.empty()) return;
  bool changed = false;
  for (const auto& [entry, is_on] : checks_) {
    const bool on = is_on();
    const auto known = checked_.find(entry);
    if (known != checked_.end() && known->second == on) continue;
    checked_[entry] = on;
    menu_.setCheckState(entry, on ? MenuHandler::CHECKED : MenuHandler::UNCHECKED);
    changed = true;
  }
  if (!changed) return;
  menu_.reApply(server_);
  server_.applyChanges();
}

std::optional<PlaneVector<double>> Handles::planePosition(const Feedback& feedback) {
  try {
    const auto transform = frames_.from(feedback->header.frame_id).transform;
    const auto point = transformed(transform, feedback->pose.position);
    return PlaneVector<double>{point.x, point.z};
  } catch (const InputError& error) {
    if (warnings_.isDue())
      ROS_WARN_STREAM("handle " << feedback->marker_name << ": " << error.what());
    return std::nullopt;
  }
}

void Handles::onFeedback(std::ptrdiff_t particle, const Feedback& feedback) {
  // The server has taken over the pose of the mouse, which may not be a number.
  if (run_.isFinite()) server_.setPose(nameOf(particle), poseOf(particle));
  switch (feedback->event_type) {
    case InteractiveMarkerFeedback::MOUSE_DOWN:
    case InteractiveMarkerFeedback::KEEP_ALIVE:
    case InteractiveMarkerFeedback::POSE_UPDATE: {
      const bool is_new = drags_.count(particle) == 0;
      if (is_new && feedback->event_type == InteractiveMarkerFeedback::KEEP_ALIVE) return;
      const bool was_held =
          is_new ? driver_.isHeld(particle) || particle == 0 : drags_[particle].was_held;
      if (feedback->event_type == InteractiveMarkerFeedback::POSE_UPDATE) {
        const auto position = planePosition(feedback);
        if (!position) return;
        const double dx = position->x - run_.state().x()[particle];
        const double dy = position->y - run_.state().y()[particle];
        if (std::hypot(dx, dy) <= farthest_) {  // false for a position that is not finite
          ask(Hold{particle, Target{*position, {}, {}}});
        } else {
          if (warnings_.isDue())
            ROS_WARN_STREAM("handle " << feedback->marker_name
                                      << ": the mouse is too far away to be followed");
        }
      } else if (is_new) {
        ask(Hold{particle, {}});
      }
      drags_[particle] = {ros::SteadyTime::now(), was_held};
      return;
    }
    case InteractiveMarkerFeedback::MOUSE_UP: {
      const auto drag = drags_.find(particle);
      if (drag == drags_.end()) return;
      if (!drag->second.was_held) ask(Release{particle});
      drags_.erase(drag);
      return;
    }
    default:
      return;
  }
}

void Handles::releaseSilent() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  for (auto drag = drags_.begin(); drag != drags_.end();) {
    if ((now - drag->second.heard).toSec() < kLongestSilence) {
      ++drag;
      continue;
    }
    ROS_WARN_STREAM("particle " << drag->first + 1
                                << ": no input from the mouse for 1 s: released");
    if (!drag->second.was_held) ask(Release{drag->first});
    drag = drags_.erase(drag);
  }
}

geometry_msgs::Pose Handles::poseOf(std::ptrdiff_t particle) const {
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  pose.position.x = run_.state().x()[particle];
  pose.position.y = y_;
  pose.position.z = run_.state().y()[particle];
  return pose;
}

void Handles::show() {
  if (updates_.getNumSubscribers() == 0) return;
  for (const std::ptrdiff_t particle : particles_) {
    server_.setPose(nameOf(particle), poseOf(particle));
  }
  checkMenu();
  server_.applyChanges();
}

void Handles::reset() {
  drags_.clear();
}

}  // namespace spring_pendulum

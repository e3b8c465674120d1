#include "ros/inputs/handles.hpp"

#include "base/numbers.hpp"
#include "ros/markers/markers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <ros/console.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

using interactive_markers::MenuHandler;
using visualization_msgs::InteractiveMarkerFeedback;

constexpr double kLongestSilence = 1.0;  // s
constexpr Eigen::Index kMostHandles = 20;
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
  ball.color.a = 0.01F;  // not seen, until the mouse is over it
  control.markers.push_back(ball);
  return control;
}

}  // namespace

Handles::Handles(ros::NodeHandle& node, const Run& run, const NodeOptions& options,
                 const Driver& driver, Frames& frames, RequestHandler take)
    : run_(run),
      driver_(driver),
      frames_(frames),
      take_(std::move(take)),
      frame_id_(options.frame_id),
      farthest_(10.0 * std::max(chainLength(run.chain(), run.start()), 1.0)),
      server_(node.resolveName("handles")),
      particles_(evenlyChosen(run.chain().size(), kMostHandles)),
      updates_(node.advertise<visualization_msgs::InteractiveMarkerUpdate>("handles/update", 100)) {
  const double length = std::max(chainLength(run.chain(), run.start()), 0.1);
  const auto count = static_cast<double>(particles_.size());
  makeMenu();
  for (const std::ptrdiff_t particle : particles_) {
    insert(particle, std::min(kSize * length, kShareOfSpring * length / count));
  }
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

MenuHandler::FeedbackCallback Handles::asks(std::function<Request(std::ptrdiff_t)> request) {
  return [this, request = std::move(request)](const Feedback& feedback) {
    for (const std::ptrdiff_t particle : particles_) {
      if (feedback->marker_name == nameOf(particle)) ask(request(particle));
    }
  };
}

void Handles::makeMenu() {
  menu_.insert("Pause or go on", asks([](std::ptrdiff_t) { return Pause{}; }));
  menu_.insert("Step", asks([this](std::ptrdiff_t) {
                 ask(Pause{true});
                 return Step{};
               }));
  menu_.insert("Reset", asks([](std::ptrdiff_t) { return Reset{}; }));
  menu_.insert("Save state", asks([](std::ptrdiff_t) { return SaveState{}; }));
  menu_.insert("Hold here", asks([](std::ptrdiff_t i) { return Hold{i, {}}; }));
  menu_.insert("Release", asks([](std::ptrdiff_t i) { return Release{i}; }));
  addSwitch("damping", [](const Constants& c) { return c.spring.damping; });
  addSwitch("gravity", [](const Constants& c) { return c.gravity; });
  const MenuHandler::EntryHandle methods = menu_.insert("Method");
  for (const Method& method : methodTable()) {
    menu_.insert(methods, method.name, asks([&method](std::ptrdiff_t) {
                   return SetConstant{"method", method.name};
                 }));
  }
}

void Handles::addSwitch(const std::string& name, double (*constant)(const Constants&)) {
  const double launched = constant(run_.chain().constants());
  const double on = launched != 0.0 ? launched : constant(Constants{});
  std::string title = name + " on or off";
  title.front() = static_cast<char>(std::toupper(title.front()));
  menu_.insert(title, asks([this, name, constant, on](std::ptrdiff_t) {
                 const bool is_off = constant(driver_.wanted().constants) == 0.0;
                 return SetConstant{name, numberText(is_off ? on : 0.0)};
               }));
}

std::optional<Target> Handles::targetOf(std::ptrdiff_t particle, const Feedback& feedback) {
  const auto& at = feedback->pose.position;
  std::string problem = "the mouse is too far away to be followed";
  try {
    const tf2::Vector3 point =
        frames_.from(feedback->header.frame_id).transform * tf2::Vector3(at.x, at.y, at.z);
    const double distance =
        std::hypot(point.x() - run_.state().x()[particle], point.z() - run_.state().y()[particle]);
    if (distance <= farthest_) return Target{{point.x(), point.z()}, {}, {}};
  } catch (const InputError& error) {
    problem = error.what();
  }
  if (warnings_.isDue()) ROS_WARN_STREAM("handle " << feedback->marker_name << ": " << problem);
  return std::nullopt;
}

void Handles::onFeedback(std::ptrdiff_t particle, const Feedback& feedback) {
  // The server has taken over the pose of the mouse, which may not be a number.
  if (run_.isFinite()) server_.setPose(nameOf(particle), poseOf(particle));
  const auto drag = drags_.find(particle);
  std::optional<Target> target;
  switch (feedback->event_type) {
    case InteractiveMarkerFeedback::MOUSE_UP:
      if (drag != drags_.end()) release(drag);
      return;
    case InteractiveMarkerFeedback::POSE_UPDATE:
      target = targetOf(particle, feedback);
      if (!target) return;
      break;
    case InteractiveMarkerFeedback::MOUSE_DOWN:
      break;
    case InteractiveMarkerFeedback::KEEP_ALIVE:
      if (drag != drags_.end()) break;
      return;
    default:
      return;
  }
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (drag == drags_.end()) {
    drags_[particle] = {now, driver_.isHeld(particle) || particle == 0};
  } else {
    drag->second.heard = now;
    if (!target) return;
  }
  ask(Hold{particle, target});
}

Handles::Drags::iterator Handles::release(Drags::iterator drag) {
  if (!drag->second.was_held) ask(Release{drag->first});
  return drags_.erase(drag);
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
    drag = release(drag);
  }
}

geometry_msgs::Pose Handles::poseOf(std::ptrdiff_t particle) const {
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  pose.position = pointOf(run_.state(), particle);
  return pose;
}

void Handles::show() {
  if (updates_.getNumSubscribers() == 0) return;
  for (const std::ptrdiff_t particle : particles_) {
    server_.setPose(nameOf(particle), poseOf(particle));
  }
  server_.applyChanges();
}

}  // namespace spring_pendulum

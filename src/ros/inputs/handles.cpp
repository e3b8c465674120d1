#include "ros/inputs/handles.hpp"

#include "ros/markers/picture.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr double kLongestSilence = 1.0;  // s
constexpr Eigen::Index kMostHandles = 20;
constexpr double kSize = 0.08;          // largest diameter of a handle, in chain lengths
constexpr double kShareOfSpring = 0.7;  // largest diameter, in distances between handles

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
      farthest_(10.0 * std::max(chainLength(run.chain(), run.start()), 1.0)),
      server_(node.resolveName("handles")),
      particles_(evenlyChosen(run.chain().size(), kMostHandles)),
      updates_(node.advertise<visualization_msgs::InteractiveMarkerUpdate>(
          node.resolveName("handles") + "/update", 100)) {
  const double size = std::max(chainLength(run.chain(), run.start()), 0.1) *
                      std::min(kSize, kShareOfSpring / static_cast<double>(particles_.size()));
  for (const std::ptrdiff_t particle : particles_) {
    visualization_msgs::InteractiveMarker marker;
    marker.header.frame_id = options.frame_id;
    marker.name = nameOf(particle);
    marker.scale = static_cast<float>(size);
    marker.pose = poseOf(particle);
    marker.controls.push_back(movingControl());
    auto& scale = marker.controls.back().markers.back().scale;
    scale.x = scale.y = scale.z = size;
    server_.insert(marker, [this, particle](const Feedback& f) { onFeedback(particle, f); });
  }
  server_.applyChanges();
}

void Handles::ask(const Request& request) {
  try {
    take_(request);
  } catch (const InputError& error) {
    if (warnings_.isDue()) ROS_WARN_STREAM(error.what());
  }
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
  using Event = visualization_msgs::InteractiveMarkerFeedback;
  // The server has taken over the pose of the mouse, which may not be a number.
  if (run_.isFinite()) server_.setPose(nameOf(particle), poseOf(particle));
  const auto event = feedback->event_type;
  if (event == Event::MOUSE_UP) return release(particle);
  const bool pulls = event == Event::POSE_UPDATE, grabs = pulls || event == Event::MOUSE_DOWN;
  const std::optional<Target> target = pulls ? targetOf(particle, feedback) : std::nullopt;
  if ((pulls && !target) || (!grabs && event != Event::KEEP_ALIVE)) return;
  const bool was_held = driver_.isHeld(particle) || particle == 0;
  const bool is_new = grabs && drags_.try_emplace(particle, Drag{{}, was_held}).second;
  const auto drag = drags_.find(particle);
  if (drag == drags_.end()) return;
  drag->second.heard = ros::SteadyTime::now();
  if (is_new || target) ask(Hold{particle, target});
}

void Handles::release(std::ptrdiff_t particle) {
  const auto drag = drags_.extract(particle);  // first: asking may call this again
  if (drag.empty()) return;
  ask(drag.mapped().was_held ? Request(Hold{particle, {}}) : Request(Release{particle}));
}

void Handles::releaseSilent() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  for (const auto& [particle, drag] : std::map(drags_)) {
    if ((now - drag.heard).toSec() < kLongestSilence) continue;
    ROS_WARN_STREAM("particle " << particle + 1 << ": no input from the mouse for 1 s: released");
    release(particle);
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
  for (const std::ptrdiff_t particle : particles_)
    server_.setPose(nameOf(particle), poseOf(particle));
  server_.applyChanges();
}

}  // namespace spring_pendulum

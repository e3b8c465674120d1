#include "ros/parameters/node_options.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/names.h>

#include <regex>

namespace spring_pendulum {
namespace {

bool isFrame(std::string_view text) {
  return text.empty() || (text.front() != '/' && text.find(' ') == std::string_view::npos);
}

bool isColor(std::string_view text) {
  return std::regex_match(std::string(text), std::regex("|#[0-9a-fA-F]{6}"));
}

}  // namespace

bool isTopicName(std::string_view text) {
  std::string reason;
  const bool is_private = !text.empty() && text.front() == '~';
  return !is_private && ros::names::validate(std::string(text), reason);
}

std::vector<Option> displayOptions(NodeOptions& o) {
  return {
      {"frame_id",
       Text{&o.frame_id, "NAME", "a name without a leading '/'",
            [](std::string_view text) { return !text.empty() && isFrame(text); }},
       "", "tf frame of all messages; the chain moves in its x-z plane"},
      {"display_rate", Number{&o.display_rate, Range::atLeast(0)}, "Hz",
       "states published per second on average, also between frames; the frame files do not "
       "change; "
       "0: frames only"},
      {"track_dissipation", Flag{&o.track_dissipation}, "",
       "always integrate the dissipated energy; false: only where it is cheap, as in Exercise3"},
      {"color",
       Text{&o.color, "#rrggbb", "#rrggbb, or empty for colours by strain and mass", isColor}, "",
       "one colour for the whole chain instead of colours by strain and mass"},
      {"display_limit", Count{&o.display_limit, Range::atLeast(2)}, "",
       "largest number of particles drawn; a longer chain is thinned, in the markers only"},
      {"text_row", Count{&o.text_row, Range::atLeast(0)}, "",
       "0: the only chain in the picture; else its line of text, counted upwards from 1: the first "
       "chain draws the grid and sets the camera, and the others are behind it and wider"},
      {"camera_frame",
       Text{&o.camera_frame, "NAME", "a name without a leading '/', or empty for none", isFrame},
       "", "tf frame of the camera that shows the whole scene"},
  };
}

std::vector<Option> playOptions(NodeOptions& o) {
  return {
      {"real_time_factor", Number{&o.real_time_factor, Range::atLeast(0)}, "",
       "simulated seconds per second; 0: as fast as possible"},
      {"at_end", Choice(&o.at_end, {"hold", "exit"}), "", "what to do after the last frame"},
      {"wait_for_subscribers", Count{&o.wait_for_subscribers, Range::atLeast(0)}, "",
       "start when markers, state and status have this many subscribers in all"},
      {"wait_timeout", Number{&o.wait_timeout, Range::atLeast(0)}, "s",
       "start without them after this time; 0: wait forever"},
      {"publish_clock", Flag{&o.publish_clock}, "",
       "publish simulated time on /clock and stamp with it"},
      {"held", Text{&o.held, "LIST", "particles such as '1, last=gripper', or empty", anyText}, "",
       "particles that follow held_<i>/odom or held_<i>/pose, or a tf frame such as gripper"},
  };
}

void checkNodeOptions(const NodeOptions& options) {
  if (options.camera_frame == options.frame_id) {
    throw InputError(fmt::format("camera_frame: must not be frame_id, '{}'", options.frame_id));
  }
}

}  // namespace spring_pendulum

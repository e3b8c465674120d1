// The ROS options besides the scenario: display, pace and publishing.
#pragma once

#include <spring_pendulum/simulation/option.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

enum class AtEnd { kHold, kExit, kLoop };

/// The initialisers are the defaults, and their only definition.
struct NodeOptions {
  std::string frame_id = "world";
  double real_time_factor = 1.0;  ///< simulated seconds per second; 0: as fast as possible
  double display_rate = 30.0;     ///< Hz, states shown per second; 0: frames only
  AtEnd at_end = AtEnd::kHold;
  std::int64_t wait_for_subscribers = 0;
  double wait_timeout = 30.0;  ///< s; 0: unlimited
  bool publish_clock = false;
  std::string follow;                  ///< topic of another node's state
  bool track_dissipation = true;       ///< integrate the dissipated power as well
  double trail = 2.0;                  ///< s, length of the tip's trail; 0: none
  std::string color;                   ///< "#rrggbb"; empty: by strain and mass
  std::int64_t display_limit = 10000;  ///< largest number of drawn particles
  bool show_reference = false;         ///< draw the reference run as a pale second chain
  std::int64_t text_row = 0;           ///< line of text, counted upwards; 0: the only chain
  std::string held;                    ///< particles that robots hold: "1, last"
  std::map<std::int64_t, std::string> held_frames;  ///< tf frames of their holders, by particle
  std::string tf_particles;                         ///< particles with a tf frame
  std::string camera_frame = "pendulum_camera";     ///< empty: none

  /// Simulated time between two shown states, s; 0: only frames are shown.
  double displayInterval() const {
    const bool smooth = display_rate > 0.0 && real_time_factor > 0.0;
    return smooth ? real_time_factor / display_rate : 0.0;
  }
};

/// Whether ROS accepts a topic or namespace of this name; it may be empty.
bool isTopicName(std::string_view text);

/// Display options, which the node and record_bag share. Bound to `options`.
std::vector<Option> displayOptions(NodeOptions& options);

/// Options of the node only. Bound to `options`.
std::vector<Option> playOptions(NodeOptions& options);

}  // namespace spring_pendulum

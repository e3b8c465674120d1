// What the ROS side can be told besides the scenario: how the chain is shown, paced and published.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace spring_pendulum {

/// The initialisers are the defaults; there is no second place for them.
struct NodeOptions {
  std::string frame_id = "world";
  double real_time_factor = 1.0;  ///< simulated seconds a second; 0: as fast as possible
  double display_rate = 30.0;     ///< Hz, states shown a second; 0: frames only
  std::string at_end = "hold";
  std::int64_t wait_for_subscribers = 0;
  double wait_timeout = 30.0;  ///< s; 0: for ever
  bool publish_clock = false;
  std::string follow;                  ///< topic of another node's state
  bool track_energy = true;            ///< integrate the dissipated power along
  double trail = 2.0;                  ///< s, length of the tip's trail; 0: none
  std::string color;                   ///< "#rrggbb"; empty: by strain and mass
  std::int64_t display_limit = 10000;  ///< particles drawn at most
  double y_offset = 0.0;               ///< m, where the plane of the motion lies
  std::int64_t text_row = 0;           ///< the text stands so many rows above the first one
};

/// One option: `_display_rate` in ROS, `--display-rate` for record_bag.
struct NodeOption {
  using Member = std::variant<double NodeOptions::*, std::int64_t NodeOptions::*,
                              bool NodeOptions::*, std::string NodeOptions::*>;
  std::string_view key;
  Member member;
  std::string_view unit;                ///< empty if it has none
  std::string_view range;               ///< in words
  std::string_view meaning;             ///< one line
  bool (*accepts)(const NodeOptions&);  ///< whether the value is in its range
  bool for_bags = true;                 ///< whether it has a meaning for record_bag
};

/// All options, in the order in which they are listed to a user.
const std::vector<NodeOption>& nodeOptionTable();

/// The value of an option as text that `setNodeOption` reads back.
std::string formatValue(const NodeOption& option, const NodeOptions& options);

/// \param where put before an error message: "/pendulum_node"
/// \return false if there is no option of this name
/// \throws InputError naming key, value and allowed range
bool setNodeOption(NodeOptions& options, std::string_view key, std::string_view text,
                   std::string_view where);

}  // namespace spring_pendulum

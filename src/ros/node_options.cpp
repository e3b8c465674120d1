#include "ros/node_options.hpp"

#include "model/numbers.hpp"
#include "ros/color.hpp"
#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>

#include <optional>

namespace spring_pendulum {
namespace {

template <double NodeOptions::*member>
bool atLeastZero(const NodeOptions& options) {
  return options.*member >= 0.0;
}

template <std::int64_t NodeOptions::*member, std::int64_t least>
bool atLeast(const NodeOptions& options) {
  return options.*member >= least;
}

bool always(const NodeOptions&) {
  return true;
}

bool isFrameName(const NodeOptions& options) {
  return !options.frame_id.empty() && options.frame_id.front() != '/' &&
         options.frame_id.find(' ') == std::string::npos;
}

bool isEnding(const NodeOptions& options) {
  return options.at_end == "hold" || options.at_end == "exit" || options.at_end == "loop";
}

bool isColor(const NodeOptions& options) {
  return options.color.empty() || parseColor(options.color).has_value();
}

/// Text to a value of the option's type.
bool assign(double& value, std::string_view text) {
  const std::optional<double> number = parseNumber(text);
  value = number.value_or(value);
  return number.has_value();
}

bool assign(std::int64_t& value, std::string_view text) {
  const std::optional<std::int64_t> number = parseInteger(text);
  value = number.value_or(value);
  return number.has_value();
}

bool assign(bool& value, std::string_view text) {
  value = text == "true";
  return value || text == "false";
}

bool assign(std::string& value, std::string_view text) {
  value = text;
  return true;
}

}  // namespace

const std::vector<NodeOption>& nodeOptionTable() {
  using O = NodeOptions;
  static const std::vector<NodeOption> kTable{
      {"frame_id", &O::frame_id, "", "a name without a leading '/'",
       "tf frame of all messages; the plane of the motion is its x-z plane", isFrameName},
      {"real_time_factor", &O::real_time_factor, "", "a number of at least 0",
       "simulated seconds a second; 0: as fast as possible", atLeastZero<&O::real_time_factor>,
       false},
      {"display_rate", &O::display_rate, "Hz", "a number of at least 0",
       "states published a second, with states between the frames; 0: frames only",
       atLeastZero<&O::display_rate>},
      {"at_end", &O::at_end, "", "hold, exit or loop", "what happens after the last frame",
       isEnding, false},
      {"wait_for_subscribers", &O::wait_for_subscribers, "", "a whole number of at least 0",
       "start when markers, state and status have so many subscribers in all",
       atLeast<&O::wait_for_subscribers, 0>, false},
      {"wait_timeout", &O::wait_timeout, "s", "a number of at least 0",
       "start without them after this time; 0: never", atLeastZero<&O::wait_timeout>, false},
      {"publish_clock", &O::publish_clock, "", "true or false",
       "publish simulated time on /clock and stamp with it", always, false},
      {"follow", &O::follow, "", "a topic",
       "the state topic of another node: keep to its simulated time instead of the clock", always,
       false},
      {"track_energy", &O::track_energy, "", "true or false",
       "integrate the dissipated energy along, for the energy error", always},
      {"trail", &O::trail, "s", "a number of at least 0", "length of the tip's trail; 0: none",
       atLeastZero<&O::trail>},
      {"color", &O::color, "", "#rrggbb, or nothing for colours by strain and mass",
       "one colour for the whole chain", isColor},
      {"display_limit", &O::display_limit, "", "a whole number of at least 2",
       "particles drawn at most; a longer chain is thinned, in the markers only",
       atLeast<&O::display_limit, 2>},
      {"y_offset", &O::y_offset, "m", "a number", "where the plane of the motion lies", always},
      {"text_row", &O::text_row, "", "a whole number of at least 0",
       "row of the text, counted upwards", atLeast<&O::text_row, 0>},
  };
  return kTable;
}

std::string formatValue(const NodeOption& option, const NodeOptions& options) {
  return std::visit([&](auto member) { return fmt::format("{}", options.*member); }, option.member);
}

bool setNodeOption(NodeOptions& options, std::string_view key, std::string_view text,
                   std::string_view where) {
  for (const NodeOption& option : nodeOptionTable()) {
    if (option.key != key) continue;
    const bool read =
        std::visit([&](auto member) { return assign(options.*member, text); }, option.member);
    if (read && option.accepts(options)) return true;
    throw InputError(fmt::format("{}: {} is '{}': must be {}{}{}", where, key, text, option.range,
                                 option.unit.empty() ? "" : " ", option.unit));
  }
  return false;
}

}  // namespace spring_pendulum

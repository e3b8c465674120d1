// The options of a run by name and text, for a program that gets them from its user.
#pragma once

#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <utility>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// What a user needs to know about an option.
struct OptionDescription {
  std::string key;        ///< "time_step"
  std::string value;      ///< the default: "0.01"
  std::string unit;       ///< "s"; empty: none
  std::string range;      ///< the accepted values: "a number above 0 s"
  std::string meaning;    ///< one line
  std::string users;      ///< "fixed-step methods"; empty: all methods
  bool is_text = false;   ///< a name, a file or a folder
  bool is_flag = false;   ///< "true" or "false"
  bool is_count = false;  ///< a whole number
};

/// Returns all options of a run, in the order of the help text.
/// \param defaults scenario with the default values
std::vector<OptionDescription> describeOptions(const Scenario& defaults = {});

/// Makes a scenario from pairs of key and value.
/// \param options later pairs override earlier ones
/// \param scenario values of the options that are not given
/// \throws InputError naming the option and its range for a wrong value, an unknown key (with the
///   nearest known one), an option that the method does not use, or options that contradict each other
Scenario makeScenario(const std::vector<std::pair<std::string, std::string>>& options,
                      Scenario scenario = {});

}  // namespace spring_pendulum
#pragma GCC visibility pop

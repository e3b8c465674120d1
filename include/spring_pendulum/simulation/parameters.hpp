// The table of all parameters of a run, with their units and ranges, and the one place where their
// values are validated. Command line, YAML and ROS parameters are thin adapters: each hands key and
// text to a ScenarioBuilder.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace spring_pendulum {

/// Which methods a parameter has a meaning for.
enum class AppliesTo { kAllMethods, kFixedStep, kErrorControlled };

/// One parameter: `time_step` in YAML, `--time-step` on the command line, `_time_step` in ROS.
struct Parameter {
  using Member = std::variant<double Scenario::*, std::int64_t Scenario::*, bool Scenario::*,
                              std::string Scenario::*>;
  std::string_view key;
  Member member;
  std::string_view unit;     ///< empty if it has none
  std::string_view range;    ///< in words
  std::string_view meaning;  ///< one line
  AppliesTo applies_to = AppliesTo::kAllMethods;
  double least = 0.0;                          ///< numbers: smallest allowed value
  bool least_allowed = false;                  ///< numbers: whether `least` itself is allowed
  std::vector<std::string_view> choices = {};  ///< text: the allowed ones; empty: any
};

/// All parameters, in the order in which they are listed to a user.
const std::vector<Parameter>& parameterTable();

/// \param where put before an error message: "pendulum.yaml:3", "--time-step"
/// \throws InputError that lists the known keys if there is no such parameter
const Parameter& findParameter(std::string_view key, std::string_view where = "");

/// The value of a parameter as text that `ScenarioBuilder::set` reads back.
std::string formatValue(const Parameter& parameter, const Scenario& scenario);

/// Collects values from one or several sources; what comes later wins.
class ScenarioBuilder {
 public:
  /// Sets one parameter from text.
  /// \param where put before an error message, also one of `build`
  /// \throws InputError naming key, value and allowed range
  void set(std::string_view key, std::string_view text, std::string_view where);

  /// Whether a parameter has been set.
  bool isGiven(std::string_view key) const { return given_.find(key) != given_.end(); }

  /// \throws InputError for an unknown method, or a parameter that the method has no use for
  Scenario build() const;

 private:
  const Method& findGivenMethod() const;

  Scenario scenario_;
  std::map<std::string, std::string, std::less<>> given_;  ///< key and where it was last set
};

}  // namespace spring_pendulum

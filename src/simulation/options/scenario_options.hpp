// The options of a program, and checks that involve several options of a run.
#pragma once

#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spring_pendulum {

/// The options of a program, set from one or more sources. Later sources override earlier ones.
class OptionSet {
 public:
  /// \param options bound to variables that must outlive this set
  explicit OptionSet(std::vector<Option> options) : options_(std::move(options)) {}

  void add(std::vector<Option> options);
  const std::vector<Option>& options() const { return options_; }

  /// \param place prefix of error messages: "pendulum.yaml:3"; empty: none
  /// \param kind  what the user calls an option
  /// \throws InputError that lists the known keys if there is no such option
  const Option& find(std::string_view key, std::string_view place,
                     std::string_view kind = "parameter") const;

  /// Sets one option from text.
  /// \param place prefix of error messages: "--time-step", "pendulum.yaml:3: time_step"
  /// \throws InputError with place, range and text
  void set(const Option& option, std::string_view text, const std::string& place);

  bool isGiven(std::string_view key) const { return given_.count(key) > 0; }
  /// Where an option was last set; empty if it was not set.
  std::string placeOf(std::string_view key) const;

 private:
  std::vector<Option> options_;
  std::map<std::string_view, std::string> given_;  ///< key and place
};

/// \throws InputError if a number is out of range, or the run has too many steps or no finite end
void checkPlan(const Plan& plan);

/// \throws InputError as checkPlan for all options, and if options exclude each other
void checkScenario(const Scenario& scenario);

/// \throws InputError if a run cannot start at this frame, as it is not one of the plan
void checkFirstFrame(const Plan& plan, std::int64_t frame);

/// Returns the given options that the method does not use: those for error control, or for fixed steps.
std::vector<std::string_view> unusedKeys(const Plan& plan, const OptionSet& options);

/// Returns why a method does not use such an option, and the options to use instead: "Auto chooses its
/// own steps; use tolerance and frame_interval".
/// \param name how the user writes an option
std::string whyUnused(const Method& method, std::string (*name)(std::string_view key));

}  // namespace spring_pendulum

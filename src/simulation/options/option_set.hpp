// The options of a program, set from one or more sources. Later sources override earlier ones.
#pragma once

#include <spring_pendulum/simulation/option.hpp>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

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

}  // namespace spring_pendulum

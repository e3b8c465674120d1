// One option of a program. The command line, YAML, ROS parameters, launch arguments and the help
// text use the same row.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// The range of numbers that an option accepts.
class Range {
 public:
  /// Any finite number.
  static Range any() { return {-kInfinity, false, kInfinity}; }
  static Range above(double least) { return {least, false, kInfinity}; }
  static Range atLeast(double least) { return {least, true, kInfinity}; }
  static Range between(double least, double most) { return {least, true, most}; }

  bool contains(double value) const;
  /// "above 0", "of at least 1", "from 2 to 100", or "" for any number.
  std::string text() const;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Range(double least, bool least_allowed, double most)
      : least_(least), least_allowed_(least_allowed), most_(most) {}

  double least_;
  bool least_allowed_;
  double most_;
};

/// References to the variable of an option, one type per kind of value. Each has the members
///   assign(text)   stores the value; false, and nothing stored, if the text is out of range
///   text()         the value as text that `assign` accepts
///   range()        the accepted values in words
///   placeholder()  placeholder for the value in the help text; empty for an option without value
template <typename Value>
struct Ranged {
  Value* value;
  Range accepted;

  bool assign(std::string_view text) const;
  std::string text() const;
  std::string range() const;
  static std::string placeholder() { return std::is_same_v<Value, double> ? "X" : "N"; }
};
using Number = Ranged<double>;
using Count = Ranged<std::int64_t>;

struct Flag {
  bool* value;

  bool assign(std::string_view text) const;
  std::string text() const { return *value ? "true" : "false"; }
  static std::string range() { return "true or false"; }
  /// `--flag` turns a flag on. A flag that is on by default takes a value, so that it can be turned
  /// off.
  std::string placeholder() const { return *value ? "true|false" : ""; }
};

struct Text {
  std::string* value;
  std::string_view name;      ///< placeholder: "FILE"
  std::string_view accepted;  ///< accepted values in words
  bool (*accepts)(std::string_view) = [](std::string_view text) { return !text.empty(); };

  bool assign(std::string_view text) const;
  std::string text() const { return *value; }
  std::string range() const { return std::string(accepted); }
  std::string placeholder() const { return std::string(name); }
};

/// A row of the method table, given by its name.
struct MethodName {
  std::reference_wrapper<const Method>* value;

  /// \throws InputError that lists the known names if there is no such method
  bool assign(std::string_view text) const;
  std::string text() const { return value->get().name; }
  static std::string range() { return "the name of a method"; }
  static std::string placeholder() { return "METHOD"; }
};

/// One of several words, which denote the values 0, 1, ... of an enum.
class Choice {
 public:
  template <typename Enum>
  Choice(Enum* value, std::vector<std::string_view> words)
      : words_(std::move(words)),
        read_([value] { return static_cast<std::size_t>(*value); }),
        store_([value](std::size_t index) { *value = static_cast<Enum>(index); }) {}

  bool assign(std::string_view text) const;
  std::string text() const { return std::string(words_.at(read_())); }
  std::string range() const;
  std::string placeholder() const;

 private:
  std::vector<std::string_view> words_;
  std::function<std::size_t()> read_;
  std::function<void(std::size_t)> store_;
};

/// Accepts any text, also empty text.
inline bool anyText(std::string_view) {
  return true;
}

/// The methods that use an option.
enum class AppliesTo { kAllMethods, kFixedStep, kErrorControlled };

/// One option: `time_step` in YAML, `--time-step` on the command line, `_time_step` in ROS.
struct Option {
  std::string_view key;
  std::variant<Number, Count, Flag, Text, MethodName, Choice> value;
  std::string_view unit;     ///< empty: none
  std::string_view meaning;  ///< one line
  AppliesTo applies_to = AppliesTo::kAllMethods;

  /// \throws InputError without a place: "must be a number above 0 s, got '-1'"
  void assign(std::string_view text) const;
  std::string text() const;
  /// The accepted values and their unit in words: "a number above 0 s".
  std::string range() const;
  std::string placeholder() const;
  /// "fixed-step methods", for example; empty: all methods.
  std::string_view users() const;
  bool isFlag() const { return std::holds_alternative<Flag>(value); }
  bool isCount() const { return std::holds_alternative<Count>(value); }
  /// Whether YAML may put the value in quotes.
  bool isText() const;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop

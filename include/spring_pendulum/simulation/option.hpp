// One option of a program: one row for the command line, YAML, ROS parameters, launch files and help.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
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
  /// "a number above 0", "a number of at least 1", "a number from 2 to 100" or "a finite number".
  std::string text(std::string_view noun) const;

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Range(double least, bool least_allowed, double most)
      : least_(least), least_allowed_(least_allowed), most_(most) {}

  double least_;
  bool least_allowed_;
  double most_;
};

/// How an option reads and writes its variable. The kinds of values are the types derived from it.
struct OptionValue {
  /// The variable; none for a Choice.
  std::variant<std::monostate, double*, std::int64_t*, bool*, std::string*,
               std::reference_wrapper<const Method>*>
      variable;
  std::string range;        ///< the accepted values in words
  std::string placeholder;  ///< for the value in the help text; empty for an option without value
  /// Stores the value; false, and nothing stored, if the text is out of range.
  std::function<bool(std::string_view)> assign;
  std::function<std::string()> text;  ///< the value as text that `assign` accepts
};

struct Number : OptionValue {
  Number(double* value, const Range& accepted);
};

struct Count : OptionValue {
  Count(std::int64_t* value, const Range& accepted);
};

/// `--flag` turns a flag on. A flag that is on by default takes a value, so that it can be turned off.
struct Flag : OptionValue {
  explicit Flag(bool* value);
};

/// Accepts any text, also empty text.
inline bool anyText(std::string_view) {
  return true;
}

struct Text : OptionValue {
  /// \param name     placeholder: "FILE"
  /// \param accepted accepted values in words
  Text(
      std::string* value, std::string_view name, std::string_view accepted,
      bool (*accepts)(std::string_view) = [](std::string_view given) { return !given.empty(); });
};

/// A row of the method table, given by its name.
struct MethodName : OptionValue {
  explicit MethodName(std::reference_wrapper<const Method>* value);
};

/// One of several words, which denote the values 0, 1, ... of an enum.
struct Choice : OptionValue {
  template <typename Enum>
  Choice(Enum* value, const std::vector<std::string_view>& words)
      : Choice(
            words, [value] { return static_cast<std::size_t>(*value); },
            [value](std::size_t index) { *value = static_cast<Enum>(index); }) {}

 private:
  Choice(const std::vector<std::string_view>& words, const std::function<std::size_t()>& read,
         const std::function<void(std::size_t)>& store);
};

/// One option: `time_step` in YAML, `--time-step` on the command line, `_time_step` in ROS.
struct Option {
  std::string_view key;
  OptionValue value;
  std::string_view unit;                       ///< empty: none
  std::string_view meaning;                    ///< one line
  std::optional<StepControl> applies_to = {};  ///< the methods that use it; none: all

  /// \throws InputError without a place: "must be a number above 0 s, got '-1'"
  void assign(std::string_view text) const;
  std::string text() const { return value.text(); }
  /// The accepted values and their unit in words: "a number above 0 s".
  std::string range() const;
  std::string placeholder() const;
  bool isUsedBy(const Method& method) const { return !applies_to || applies_to == method.control; }
  /// "fixed-step methods", for example; empty: all methods.
  std::string_view users() const;
  /// Whether the variable is of a type.
  template <typename Variable>
  bool is() const {
    return std::holds_alternative<Variable*>(value.variable);
  }
  bool isFlag() const { return is<bool>(); }
  bool isNumber() const { return is<double>() || is<std::int64_t>(); }
  bool isText() const { return !isFlag() && !isNumber(); }  ///< may have quotes in YAML
};

}  // namespace spring_pendulum
#pragma GCC visibility pop

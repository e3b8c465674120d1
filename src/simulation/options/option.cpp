#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/option.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace spring_pendulum {
namespace {

/// Whether the text would be a number with a point instead of the comma.
bool hasDecimalComma(std::string_view text) {
  std::string with_point(text);
  std::replace(with_point.begin(), with_point.end(), ',', '.');
  return with_point != text && parseNumber(with_point).has_value();
}

template <typename Value>
std::function<bool(std::string_view)> assignment(Value* value, const Range& accepted,
                                                 std::optional<Value> (*parse)(std::string_view)) {
  return [=](std::string_view text) {
    const std::optional<Value> number = parse(text);
    if (!number || !accepted.contains(static_cast<double>(*number))) return false;
    *value = *number;
    return true;
  };
}

}  // namespace

bool Range::contains(double value) const {
  const bool is_above = value > least_ || (least_allowed_ && value == least_);
  return std::isfinite(value) && is_above && value <= most_;
}

std::string Range::text(std::string_view noun) const {
  if (std::isfinite(most_)) return fmt::format("a {} from {:g} to {:g}", noun, least_, most_);
  if (!std::isfinite(least_)) return fmt::format("a finite {}", noun);
  return fmt::format("a {} {} {:g}", noun, least_allowed_ ? "of at least" : "above", least_);
}

Number::Number(double* value, const Range& accepted)
    : OptionValue{value, accepted.text("number"), "X", assignment(value, accepted, parseNumber),
                  [value] { return numberText(*value); }} {}

Count::Count(std::int64_t* value, const Range& accepted)
    : OptionValue{value, accepted.text("whole number"), "N",
                  assignment(value, accepted, parseInteger),
                  [value] { return std::to_string(*value); }} {}

Flag::Flag(bool* value)
    : OptionValue{value, "true or false", *value ? "true|false" : "",
                  [value](std::string_view given) {
                    const bool is_true = given == "true";
                    if (!is_true && given != "false") return false;
                    *value = is_true;
                    return true;
                  },
                  [value] { return *value ? "true" : "false"; }} {}

Text::Text(std::string* value, std::string_view name, std::string_view accepted,
           bool (*accepts)(std::string_view))
    : OptionValue{value, std::string(accepted), std::string(name),
                  [=](std::string_view given) {
                    if (given.find('\0') != std::string_view::npos || !accepts(given)) return false;
                    *value = given;
                    return true;
                  },
                  [value] { return *value; }} {}

MethodName::MethodName(std::reference_wrapper<const Method>* value)
    : OptionValue{value, "the name of a method", "METHOD",
                  [value](std::string_view given) {
                    if (given.empty()) return false;
                    *value = findMethod(given);
                    return true;
                  },
                  [value] { return value->get().name; }} {}

Choice::Choice(const std::vector<std::string_view>& words, const std::function<std::size_t()>& read,
               const std::function<void(std::size_t)>& store)
    : OptionValue{{},
                  "",
                  fmt::format("{}", fmt::join(words, "|")),
                  [=](std::string_view given) {
                    const auto word = std::find(words.begin(), words.end(), given);
                    if (word == words.end()) return false;
                    store(static_cast<std::size_t>(word - words.begin()));
                    return true;
                  },
                  [=] { return std::string(words.at(read())); }} {
  const auto last = words.end() - 1;
  range = fmt::format("{} or {}", fmt::join(words.begin(), last, ", "), *last);
}

void Option::assign(std::string_view text) const {
  if (value.assign(text)) return;
  if (!isText() && hasDecimalComma(text))
    throw InputError(fmt::format("{} is not a number; use a decimal point", inQuotes(text)));
  throw InputError(fmt::format("must be {}, got {}", range(), inQuotes(text)));
}

std::string Option::range() const {
  if (unit.empty()) return value.range;
  const bool ends_with_limit = value.range.back() >= '0' && value.range.back() <= '9';
  return fmt::format("{} {}{}", value.range, ends_with_limit ? "" : "in ", unit);
}

std::string Option::placeholder() const {
  if (unit == "s") return "SECONDS";
  if (unit == "m") return "METRES";
  return value.placeholder;
}

std::string_view Option::users() const {
  if (!applies_to) return "";
  return applies_to == StepControl::kFixed ? "fixed-step methods" : "error-controlled methods";
}

}  // namespace spring_pendulum

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

}  // namespace

bool Range::contains(double value) const {
  const bool is_above = value > least_ || (least_allowed_ && value == least_);
  return std::isfinite(value) && is_above && value <= most_;
}

std::string Range::text() const {
  if (std::isfinite(most_)) return fmt::format("from {:g} to {:g}", least_, most_);
  if (!std::isfinite(least_)) return "";
  return fmt::format("{} {:g}", least_allowed_ ? "of at least" : "above", least_);
}

template <typename Value>
bool Ranged<Value>::assign(std::string_view text) const {
  std::optional<Value> number;
  if constexpr (std::is_same_v<Value, double>) {
    number = parseNumber(text);
  } else {
    number = parseInteger(text);
  }
  if (!number || !accepted.contains(static_cast<double>(*number))) return false;
  *value = *number;
  return true;
}

template <typename Value>
std::string Ranged<Value>::text() const {
  return std::is_same_v<Value, double> ? numberText(static_cast<double>(*value))
                                       : std::to_string(*value);
}

template <typename Value>
std::string Ranged<Value>::range() const {
  const std::string noun = std::is_same_v<Value, double> ? "number" : "whole number";
  const std::string limits = accepted.text();
  return limits.empty() ? "a finite " + noun : fmt::format("a {} {}", noun, limits);
}

template struct Ranged<double>;
template struct Ranged<std::int64_t>;

bool Flag::assign(std::string_view text) const {
  if (text != "true" && text != "false") return false;
  *value = text == "true";
  return true;
}

bool Text::assign(std::string_view text) const {
  if (text.find('\0') != std::string_view::npos || !accepts(text)) return false;
  *value = text;
  return true;
}

bool MethodName::assign(std::string_view text) const {
  if (text.empty()) return false;
  *value = findMethod(text);
  return true;
}

bool Choice::assign(std::string_view text) const {
  const auto word = std::find(words_.begin(), words_.end(), text);
  if (word == words_.end()) return false;
  store_(static_cast<std::size_t>(word - words_.begin()));
  return true;
}

std::string Choice::range() const {
  std::string text(words_.front());
  for (std::size_t i = 1; i < words_.size(); ++i) {
    text += fmt::format("{}{}", i + 1 == words_.size() ? " or " : ", ", words_[i]);
  }
  return text;
}

std::string Choice::placeholder() const {
  return fmt::format("{}", fmt::join(words_, "|"));
}

void Option::assign(std::string_view text) const {
  if (std::visit([&](const auto& kind) { return kind.assign(text); }, value)) return;
  if (!isText() && hasDecimalComma(text)) {
    throw InputError(fmt::format("{} is not a number; use a decimal point", inQuotes(text)));
  }
  throw InputError(fmt::format("must be {}, got {}", range(), inQuotes(text)));
}

std::string Option::text() const {
  return std::visit([](const auto& kind) { return kind.text(); }, value);
}

std::string Option::range() const {
  std::string accepted = std::visit([](const auto& kind) { return kind.range(); }, value);
  if (unit.empty()) return accepted;
  const bool ends_with_limit = accepted.back() >= '0' && accepted.back() <= '9';
  return fmt::format("{} {}{}", accepted, ends_with_limit ? "" : "in ", unit);
}

std::string Option::placeholder() const {
  if (unit == "s") return "SECONDS";
  if (unit == "m") return "METRES";
  return std::visit([](const auto& kind) { return kind.placeholder(); }, value);
}

std::string_view Option::users() const {
  if (applies_to == AppliesTo::kAllMethods) return "";
  return applies_to == AppliesTo::kFixedStep ? "fixed-step methods" : "error-controlled methods";
}

bool Option::isText() const {
  return std::holds_alternative<Text>(value) || std::holds_alternative<MethodName>(value) ||
         std::holds_alternative<Choice>(value);
}

}  // namespace spring_pendulum

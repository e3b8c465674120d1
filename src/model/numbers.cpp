#include "model/numbers.hpp"

#include <fast_float/fast_float.h>

#include <charconv>
#include <cmath>
#include <system_error>

namespace spring_pendulum {
namespace {

std::string_view withoutPlus(std::string_view text) {
  const bool sign_then_digit = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return sign_then_digit ? text.substr(1) : text;
}

}  // namespace

std::optional<double> parseNumber(std::string_view text) {
  text = withoutPlus(text);
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = fast_float::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
  text = withoutPlus(text);
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

}  // namespace spring_pendulum

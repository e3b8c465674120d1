#include "base/numbers.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <locale.h>  // NOLINT(modernize-deprecated-headers): newlocale is of POSIX
#include <string>
#include <system_error>

namespace spring_pendulum {
namespace {

std::string_view withoutPlus(std::string_view text) {
  const bool sign_then_digit = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return sign_then_digit ? text.substr(1) : text;
}

}  // namespace

std::optional<double> parseNumberPortably(std::string_view text) {
  static const locale_t kClassic = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string number(withoutPlus(text));
  // strtod also accepts a second sign, blanks, hexadecimal numbers and "inf".
  const bool is_plain = number.find_first_not_of("0123456789.eE+-") == std::string::npos;
  if (number.empty() || number.front() == '+' || !is_plain) return std::nullopt;
  char* end = nullptr;
  const double value = strtod_l(number.c_str(), &end, kClassic);
  return *end == '\0' && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<double> parseNumber(std::string_view text) {
#ifdef __cpp_lib_to_chars  // libstdc++ has std::from_chars for double since GCC 11
  const std::string_view number = withoutPlus(text);
  const char* end = number.data() + number.size();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(number.data(), end, value);
  if (error == std::errc() && rest == end && std::isfinite(value)) return value;
    // Else no number, or out of range: too large, or rounded to 0, which only strtod distinguishes.
#endif
  return parseNumberPortably(text);
}

std::optional<std::int64_t> parseInteger(std::string_view text) {
  text = withoutPlus(text);
  std::int64_t value = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || rest != end) return std::nullopt;
  return value;
}

std::string counted(std::int64_t count, std::string_view noun, std::string_view ending) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : ending);
}

char* writeNumber(double value, char* text) {
#ifdef FMT_COMPILE
  return fmt::format_to(text, FMT_COMPILE("{}"), value);
#else  // {fmt} 6, which writes 2 as 2.0
  char* const end = fmt::format_to(text, "{}", value);
  const bool whole = end - text > 2 && end[-2] == '.' && end[-1] == '0';
  return whole ? end - 2 : end;
#endif
}

char* writeLine(std::initializer_list<double> numbers, char* text) {
  for (const double number : numbers) {
    text = writeNumber(number, text);
    *text++ = ' ';
  }
  text[-1] = '\n';
  return text;
}

std::string numberText(double value) {
  std::array<char, kLongestNumber> text;
  return {text.data(), writeNumber(value, text.data())};
}

std::string roundedText(double value, int digits) {
  const auto rounded = parseNumber(fmt::format("{:.{}e}", value, digits - 1));
  return fmt::format("{:.{}g}", rounded.value_or(value), std::max(digits, 3));
}

std::string durationText(double seconds) {
  // Rounded first: 0.9996 s is "1 s", not "1e+03 ms".
  if (seconds >= 99.95) return fmt::format("{:.0f} s", seconds);
  if (seconds >= 0.9995) return fmt::format("{:.3g} s", seconds);
  return fmt::format("{:.3g} ms", std::round(seconds * 1e5) / 100.0);
}

}  // namespace spring_pendulum

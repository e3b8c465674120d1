// Numbers from and to text, the same in every locale and with every release of {fmt}.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace spring_pendulum {

/// Returns the double nearest to a decimal text ("1", "-2.5e-3", "+4"), which is ±0 for "1e-400".
/// Returns nothing if the text is not entirely a number or the value is not finite.
std::optional<double> parseNumber(std::string_view text);

/// The same without std::from_chars, slower: for standard libraries that lack it.
std::optional<double> parseNumberPortably(std::string_view text);

/// Returns a decimal integer; nothing if the text is not entirely an integer of 64 bits.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// The longest text of a double is -2.2250738585072014e-308.
constexpr std::size_t kLongestNumber = 24;

/// Writes the fewest digits that read back as the same double, and returns the end of the text.
char* writeNumber(double value, char* text);

}  // namespace spring_pendulum

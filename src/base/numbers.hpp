// Numbers from and to text, the same in every locale and with every release of {fmt}.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// Returns the double nearest to a decimal text ("1", "-2.5e-3", "+4"); 0 or -0 if it underflows.
/// Returns nothing if the text is not entirely a number or the value is not finite.
std::optional<double> parseNumber(std::string_view text);

/// The same, but slower: for standard libraries without std::from_chars for double.
std::optional<double> parseNumberPortably(std::string_view text);

/// Returns a decimal integer; nothing if the text is not entirely an integer of 64 bits.
std::optional<std::int64_t> parseInteger(std::string_view text);

/// Returns a count with its noun: "1 frame", "500 frames", "2 switches".
/// \param ending what the plural of the noun adds
std::string counted(std::int64_t count, std::string_view noun, std::string_view ending = "s");

/// The longest text of a double is -2.2250738585072014e-308.
constexpr std::size_t kLongestNumber = 24;

/// Writes the fewest digits that read back as the same double, and returns the end of the text.
char* writeNumber(double value, char* text);

/// Writes a line of numbers with blanks between them, and returns its end.
char* writeLine(std::initializer_list<double> numbers, char* text);

/// Returns the text of writeNumber(). With "{}", {fmt} before release 8 writes 2 as 2.0.
std::string numberText(double value);

/// Returns a number rounded to a few significant digits: "0.00024", "1.5e-07", "150". With {:.2g},
/// {fmt} 6 writes 0.00024 as 0.0024.
std::string roundedText(double value, int digits);

/// Returns a time with three significant digits: "1.25 s", "3.07 ms", "0.04 ms".
std::string durationText(double seconds);

}  // namespace spring_pendulum

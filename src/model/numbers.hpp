// Numbers from text, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace spring_pendulum {

/// Returns the double nearest to a decimal text ("1", "-2.5e-3", "+4"), which is ±0 for "1e-400".
/// Returns nothing if characters are left over, or the value is not finite.
std::optional<double> parseNumber(std::string_view text);

/// The same without std::from_chars, slower: for standard libraries that lack it.
std::optional<double> parseNumberPortably(std::string_view text);

/// Returns a decimal whole number, or nothing if characters are left over or it does not fit.
std::optional<std::int64_t> parseInteger(std::string_view text);

}  // namespace spring_pendulum

// Numbers from text, the same in every locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace spring_pendulum {

/// The double nearest to a decimal text ("1", "-2.5e-3", "+4"); nothing if any of the text is left
/// over, if it is no finite number, or if it is out of the range of a double.
std::optional<double> parseNumber(std::string_view text);

/// A decimal whole number; nothing if any of the text is left over or it does not fit.
std::optional<std::int64_t> parseInteger(std::string_view text);

}  // namespace spring_pendulum

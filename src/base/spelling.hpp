// Error messages: quoted text, and suggestions for names that are not known.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// Returns text with '?' for each control character and each byte that is not UTF-8. Of a text longer than
/// `most` bytes, returns the characters that begin it, and "...".
std::string onOneLine(std::string_view text, std::size_t most = std::string_view::npos);

/// Returns text in quotes for a message of one line, as onOneLine does, truncated if long.
std::string inQuotes(std::string_view text);

/// Whether two names differ at most in case and punctuation: "runge_kutta4" and "Runge-Kutta-4".
bool isSameName(std::string_view a, std::string_view b);

/// Returns the name that was probably meant: another spelling ("runge_kutta4"), a typing error
/// ("Oiler") or an abbreviation ("rk4") of exactly one of the `known` names. Else empty.
std::string closestName(std::string_view name, const std::vector<std::string>& known);

/// "unknown method 'rk4'; did you mean 'Runge-Kutta-4'? Known methods: Euler, Runge-Kutta-2, ..."
/// \param kind  "method", for example
/// \param meant the name to suggest; empty: the closest one
std::string unknownName(std::string_view kind, std::string_view name,
                        const std::vector<std::string>& known, std::string meant = "");

}  // namespace spring_pendulum

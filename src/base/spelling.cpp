#include "base/spelling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace spring_pendulum {
namespace {

constexpr std::size_t kLongestQuote = 40;

/// Only letters in lower case and digits. Names are ASCII.
std::string simplified(std::string_view name) {
  std::string text;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') text += static_cast<char>(c - 'A' + 'a');
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) text += c;
  }
  return text;
}

/// Levenshtein distance.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

/// Whether the letters of `name` occur in this order in `known`: "rk4" in "rungekutta4".
bool abbreviates(const std::string& name, const std::string& known) {
  std::size_t found = 0;
  for (const char c : known) {
    if (found < name.size() && name[found] == c) ++found;
  }
  return name.size() >= 3 && found == name.size();
}

}  // namespace

std::size_t characterLength(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (length == 0 || length > text.size()) return 0;
  char32_t code = first & (0x7fU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    const auto next = static_cast<unsigned char>(text[i]);
    if ((next & 0xc0) != 0x80) return 0;
    code = code << 6 | (next & 0x3fU);
  }
  const bool is_overlong = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  return is_overlong || is_surrogate || first > 0xf4 || code > 0x10ffff ? 0 : length;
}

std::string onOneLine(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    const auto first = static_cast<unsigned char>(text.front());
    if (length == 0 || first < 0x20 || first == 0x7f) {
      line += '?';
    } else {
      line += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return line;
}

std::string inQuotes(std::string_view text) {
  if (text.size() <= kLongestQuote) return "'" + onOneLine(text) + "'";
  std::size_t end = 0;  // not inside a character
  for (std::size_t next = 0; next <= kLongestQuote;) {
    end = next;
    next += std::max<std::size_t>(characterLength(text.substr(next)), 1);
  }
  return "'" + onOneLine(text.substr(0, end)) + "...'";
}

bool isSameName(std::string_view a, std::string_view b) {
  return simplified(a) == simplified(b);
}

std::string closestName(std::string_view name, const std::vector<std::string>& known) {
  const std::string given = simplified(name.substr(0, 100));
  std::string closest, abbreviated;
  std::size_t least = std::min<std::size_t>((given.size() + 1) / 2, 4), abbreviations = 0;
  for (const std::string& candidate : known) {
    const std::string simple = simplified(candidate);
    const std::size_t distance = editDistance(given, simple);
    if (distance == least) closest.clear();
    if (distance < least) {
      least = distance;
      closest = candidate;
    }
    if (!abbreviates(given, simple)) continue;
    ++abbreviations;
    abbreviated = candidate;
  }
  if (!closest.empty()) return closest;
  return abbreviations == 1 ? abbreviated : "";
}

std::string unknownName(std::string_view kind, std::string_view name,
                        const std::vector<std::string>& known, std::string meant) {
  if (meant.empty()) meant = closestName(name, known);
  return fmt::format("unknown {} {}; {} {}s: {}", kind, inQuotes(name),
                     meant.empty() ? "known" : fmt::format("did you mean '{}'? Known", meant), kind,
                     fmt::join(known, ", "));
}

}  // namespace spring_pendulum

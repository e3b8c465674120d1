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

/// Returns the length in bytes of the UTF-8 character at the begin of a text; 0 if it is none.
std::size_t characterLength(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (length == 0 || length > text.size() || first > 0xf4) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  const bool is_overlong = (first == 0xe0 && byte(1) < 0xa0) || (first == 0xf0 && byte(1) < 0x90);
  const bool is_surrogate = first == 0xed && byte(1) > 0x9f;
  return is_overlong || is_surrogate || (first == 0xf4 && byte(1) > 0x8f) ? 0 : length;
}

}  // namespace

std::string onOneLine(std::string_view text, std::size_t most) {
  std::string line;
  for (std::size_t at = 0, next = 0; at < text.size(); at = next) {
    const std::size_t length = characterLength(text.substr(at));
    next = at + std::max<std::size_t>(length, 1);
    if (text.size() > most && next > most) return line + "...";
    const bool is_printable = length > 1 || (length == 1 && text[at] >= ' ' && text[at] != '\x7f');
    line += is_printable ? text.substr(at, length) : "?";
  }
  return line;
}

std::string inQuotes(std::string_view text) {
  return "'" + onOneLine(text, kLongestQuote) + "'";
}

bool isSameName(std::string_view a, std::string_view b) {
  return simplified(a) == simplified(b);
}

std::string closestName(std::string_view name, const std::vector<std::string>& known) {
  const std::string given = simplified(name.substr(0, 100));
  std::string closest;
  std::vector<std::string> abbreviated;
  std::size_t least = std::min<std::size_t>((given.size() + 1) / 2, 4);
  for (const std::string& candidate : known) {
    const std::string simple = simplified(candidate);
    const std::size_t distance = editDistance(given, simple);
    if (distance == least) closest.clear();
    if (distance < least) {
      least = distance;
      closest = candidate;
    }
    if (abbreviates(given, simple)) abbreviated.push_back(candidate);
  }
  return closest.empty() && abbreviated.size() == 1 ? abbreviated.front() : closest;
}

std::string unknownName(std::string_view kind, std::string_view name,
                        const std::vector<std::string>& known, std::string meant) {
  if (meant.empty()) meant = closestName(name, known);
  return fmt::format("unknown {} {}; {} {}s: {}", kind, inQuotes(name),
                     meant.empty() ? "known" : fmt::format("did you mean '{}'? Known", meant), kind,
                     fmt::join(known, ", "));
}

}  // namespace spring_pendulum

#include "base/numbers.hpp"
#include "base/spelling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "check/check_frames.hpp"
#include "check/mistakes.hpp"

namespace spring_pendulum {
namespace {

std::string inJson(std::string_view text) {
  std::string quoted = "\"";
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    const char c = text.front();
    if (length == 0) {
      quoted += '?';
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return quoted + '"';
}

/// A list of what a function makes of each item.
template <typename Item, typename Function>
std::string listInJson(const std::vector<Item>& items, const Function& function) {
  std::string list;
  for (const Item& item : items) list += (list.empty() ? "" : ", ") + function(item);
  return '[' + list + ']';
}

std::string departureInJson(const FrameCheck& check) {
  if (!check.departure) return "null";
  const Departure& departure = *check.departure;
  return fmt::format(R"({{"from": {}, "frame": {}, "time": {}, "particle": {}, "distance": {}}})",
                     inJson(check.nearest), departure.frame, numberText(check.time),
                     departure.particle,
                     std::isfinite(departure.distance) ? numberText(departure.distance) : "null");
}

std::string explanationInJson(const Explanation& one) {
  return fmt::format(R"({{"method": {}, "mistakes": {}, "sentences": {}, "last_frame": {}}})",
                     inJson(one.method), listInJson(one.mistakes, inJson),
                     listInJson(one.sentences, inJson), one.last_frame);
}

std::string conclusionOf(const FrameCheck& check) {
  const std::string method = check.methods.empty() ? "" : check.methods.front();
  if (check.verdict == FrameVerdict::kEqual) return "equal to " + method;
  if (check.verdict == FrameVerdict::kUndecided)
    return fmt::format("undecided: equal to {} up to frame {}", method, check.last_frame);
  if (!method.empty()) return "different: frames of " + method;
  if (check.explanations.empty()) {
    return fmt::format("different from frame {} on, no known mistake", check.departure->frame);
  }
  const Explanation& first = check.explanations.front();
  return fmt::format("different: {} with {}", first.method, fmt::join(first.mistakes, " + "));
}

}  // namespace

std::string reportOf(const FrameCheck& check) {
  std::string report = check.text + "\n";
  for (const std::string& remark : check.remarks) report += "note: " + remark + "\n";
  return report;
}

std::string shortReportOf(const FrameCheck& check) {
  std::string report = conclusionOf(check);
  for (const std::string& remark : check.remarks) report += "; note: " + remark;
  return report;
}

std::string jsonOf(const FrameCheck& check, const std::string& folder) {
  return fmt::format(
      R"({{"folder": {}, "equal": {}, "undecided": {}, "methods": {}, "frames": {}, )"
      R"("last_frame": {}, "digits": {}, "departure": {}, )"
      R"("explanations": {}, "remarks": {}, "text": {}}})"
      "\n",
      inJson(folder), check.verdict == FrameVerdict::kEqual,
      check.verdict == FrameVerdict::kUndecided, listInJson(check.methods, inJson), check.frames,
      check.last_frame, check.digits, departureInJson(check),
      listInJson(check.explanations, explanationInJson), listInJson(check.remarks, inJson),
      inJson(check.text));
}

std::string jsonOfError(const std::string& message, const std::string& folder) {
  return fmt::format("{{\"folder\": {}, \"error\": {}}}\n", inJson(folder), inJson(message));
}

std::string listOfMistakes() {
  std::string list = "The program ...\n";
  for (const Mistake& mistake : knownMistakes())
    list += fmt::format("  {:<22} {}\n", mistake.name, mistake.sentence);
  list += "Fitted numbers: the program ...\n";
  for (const Constant& constant : fittedConstants())
    list += fmt::format("  {:<22} {}\n", constant.name, constant.sentence);
  return list;
}

}  // namespace spring_pendulum

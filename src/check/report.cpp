#include "base/numbers.hpp"
#include "base/spelling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "check/check_frames.hpp"
#include "check/mistakes.hpp"

namespace spring_pendulum {
namespace {

std::string inJson(std::string_view text) {
  std::string quoted = "\"";
  while (!text.empty()) {
    const std::size_t length = characterLength(text);
    const char c = text.front();
    if (c == '"' || c == '\\') quoted += '\\';
    if (length == 0) {
      quoted += '?';
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      quoted += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return quoted + '"';
}

std::string listInJson(const std::vector<std::string>& items) {
  std::string list;
  for (const std::string& item : items) list += (list.empty() ? "" : ", ") + item;
  return '[' + list + ']';
}

std::string textsInJson(const std::vector<std::string>& texts) {
  std::vector<std::string> items;
  items.reserve(texts.size());
  for (const std::string& text : texts) items.push_back(inJson(text));
  return listInJson(items);
}

std::string departureInJson(const FrameCheck& check) {
  if (!check.departure) return "null";
  const Departure& departure = *check.departure;
  return fmt::format(R"({{"from": {}, "frame": {}, "time": {}, "particle": {}, "distance": {}}})",
                     inJson(check.nearest), departure.frame, numberText(check.time),
                     departure.particle,
                     std::isfinite(departure.distance) ? numberText(departure.distance) : "null");
}

std::string explanationsInJson(const FrameCheck& check) {
  std::vector<std::string> items;
  for (const Explanation& one : check.explanations) {
    items.push_back(fmt::format(
        R"({{"method": {}, "mistakes": {}, "sentences": {}, "last_frame": {}}})",
        inJson(one.method), textsInJson(one.mistakes), textsInJson(one.sentences), one.last_frame));
  }
  return listInJson(items);
}

std::string conclusionOf(const FrameCheck& check) {
  const std::string method = check.methods.empty() ? "" : check.methods.front();
  if (check.verdict == FrameVerdict::kEqual) return "equal to " + method;
  if (check.verdict == FrameVerdict::kUndecided) {
    return fmt::format("undecided: equal to {} up to frame {}", method, check.last_frame);
  }
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
      R"({{"folder": {}, "equal": {}, "undecided": {}, "methods": {}, "frames": {}, "last_frame": {}, )"
      R"("digits": {}, "printed_digits": {}, "departure": {}, "explanations": {}, )"
      R"("remarks": {}, "text": {}}})"
      "\n",
      inJson(folder), check.verdict == FrameVerdict::kEqual,
      check.verdict == FrameVerdict::kUndecided, textsInJson(check.methods), check.frames,
      check.last_frame, check.digits, check.printed_digits, departureInJson(check),
      explanationsInJson(check), textsInJson(check.remarks), inJson(check.text));
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

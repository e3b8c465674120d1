#include "io/program/closing.hpp"

#include "base/spelling.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <cmath>

namespace spring_pendulum {

std::string durationText(double seconds) {
  // Rounded first: 0.9996 s is "1 s", not "1e+03 ms".
  if (seconds >= 99.95) return fmt::format("{:.0f} s", seconds);
  if (seconds >= 0.9995) return fmt::format("{:.3g} s", seconds);
  return fmt::format("{:.3g} ms", std::round(seconds * 1e5) / 100.0);
}

std::string writingText(const RunFiles& files) {
  const std::string destination = files.destination();
  if (destination.empty()) return "";
  return fmt::format(", {} writing{}", durationText(files.secondsWriting()), destination);
}

void printClosingLine(const std::string& text) {
  printOutput(onOneLine(text) + "\n");
  flushOutput();
}

void printRemark(const std::string& text) {
  if (!text.empty()) printError(text + "\n");
}

void printWarning(const std::string& text) {
  if (!text.empty()) printRemark("warning: " + text);
}

int conclude(const Scenario& scenario, const Chain& chain, const State& start,
             const Verdict& verdict, const std::string& tolerance_remark) {
  if (verdict.kind == VerdictKind::kDiverged) {
    printError(fmt::format("{}; {}\n", verdict.text, remedyForDivergence(chain, start, scenario)));
    return kDiverged;
  }
  if (isBad(verdict.kind) || verdict.kind == VerdictKind::kSensitive) printWarning(verdict.text);
  printWarning(tolerance_remark);
  return interruption() == 0 ? kDone : kSignalled + interruption();
}

}  // namespace spring_pendulum

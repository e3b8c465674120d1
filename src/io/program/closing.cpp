#include "io/program/closing.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include "simulation/expected_cost.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

namespace spring_pendulum {
namespace {

/// Returns a line with a remark; empty if there is none.
std::string line(const std::string& remark) {
  return remark.empty() ? "" : remark + "\n";
}

std::string memoryLine(const Run& run) {
  return line(memoryRemark(run.scenario(), run.chain().size()));
}

}  // namespace

std::string warningLine(const std::string& warning) {
  return warning.empty() ? "" : line("warning: " + warning);
}

void printClosingLine(const std::string& text) {
  printOutput(onOneLine(text) + "\n");
  flushOutput();
}

int printAdvice(const Run& run) {
  printError(memoryLine(run));
  printOutput(checkStability(run.chain(), run.start(), run.scenario()).text);
  return kDone;
}

std::string remarksOn(const Run& run) {
  return memoryLine(run) + line(remarkOn(run.scenario())) +
         warningLine(stabilityWarning(run.chain(), run.start(), run.scenario()));
}

int conclude(const Run& run) {
  const Verdict& verdict = run.verdict();
  if (verdict.kind == VerdictKind::kDiverged) {
    const std::string remedy =
        remedyForDivergence(run.chain(), run.start(), run.scenario(), interruption);
    printError(verdict.text + (remedy.empty() ? "" : "; " + remedy) + "\n");
    return kDiverged;
  }
  if (isBad(verdict.kind) || verdict.kind == VerdictKind::kSensitive)
    printError(warningLine(verdict.text));
  printError(warningLine(run.toleranceRemark()));
  return interruption() == 0 ? kDone : kSignalled + interruption();
}

}  // namespace spring_pendulum

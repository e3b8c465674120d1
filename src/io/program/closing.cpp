#include "io/program/closing.hpp"

#include "base/spelling.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/interruption.hpp"
#include "io/program/standard_streams.hpp"
#include <spring_pendulum/simulation/outcome.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

namespace spring_pendulum {
namespace {

std::string noteLines(const Remarks& remarks) {
  std::string text;
  for (const std::string& note : remarks.notes) text += note + "\n";
  return text;
}

}  // namespace

std::string warningLine(const std::string& warning) {
  return warning.empty() ? "" : "warning: " + warning + "\n";
}

void printClosingLine(const std::string& text) {
  printOutput(onOneLine(text) + "\n");
  flushOutput();
}

int printAdvice(const Run& run) {
  printError(noteLines(remarksOn(run)));
  printOutput(checkStability(run.chain(), run.start(), run.plan()).text);
  return kDone;
}

std::string startLines(const Run& run) {
  const Remarks remarks = remarksOn(run);
  return noteLines(remarks) + warningLine(remarks.warning);
}

int conclude(const Run& run) {
  const Outcome outcome = outcomeOf(run, interruption);
  for (const std::string& line : outcome.lines) {
    printError(outcome.status == 0 ? warningLine(line) : line + "\n");
  }
  return interruption() == 0 || outcome.status != 0 ? outcome.status : kSignalled + interruption();
}

}  // namespace spring_pendulum

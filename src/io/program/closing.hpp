// What a program prints when a run begins badly or has ended.
#pragma once

#include "io/formats/run_files.hpp"
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/scenario.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <string>

namespace spring_pendulum {

/// Returns a wall-clock time with three significant digits: "1.25 s", "3.07 ms", "0.04 ms".
std::string durationText(double seconds);

/// Returns ", 3.07 ms writing to /home/me/frames"; empty if the run writes no frames.
std::string writingText(const RunFiles& files);

/// Prints one line to standard output, before anything that is printed to standard error later.
/// \throws FileError if it can't be written
void printClosingLine(const std::string& text);

/// Print one line to standard error; nothing if `text` is empty.
void printRemark(const std::string& text);
void printWarning(const std::string& text);

/// Prints the warnings on a run that has ended, or its divergence with a remedy.
/// \param tolerance_remark as RunMonitor::toleranceRemark
/// \returns the exit status of the program
int conclude(const Scenario& scenario, const Chain& chain, const State& start,
             const Verdict& verdict, const std::string& tolerance_remark);

}  // namespace spring_pendulum

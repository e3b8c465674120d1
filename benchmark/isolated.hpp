// Runs a piece of work in a process of its own, so that a peer that crashes, leaves the process or
// never ends costs one point of a benchmark and not the benchmark.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

struct Isolated {
  enum class Ending { kDone, kFailed, kTooSlow } ending;
  std::string text;  ///< what the work returned, or why it failed
};

/// \param task  its result is handed over as text; an exception means failure
/// \param limit s of processor time; after that it is ended
Isolated runIsolated(const std::function<std::string()>& task, double limit);

/// The numbers of a text, which whitespace separates; nan and inf are numbers too.
std::vector<double> numbersOf(const std::string& text);

}  // namespace spring_pendulum::benchmark

// Runs a piece of work in a separate process. If a peer crashes, exits or never ends, the benchmark
// loses one point instead of all.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

struct Isolated {
  enum class Ending { kDone, kFailed, kTooSlow } ending;
  std::string text;  ///< result of the work, or reason of its failure
};

/// \param task  returns its result as text; an exception means failure
/// \param limit processor time in s, after which the process is ended
Isolated runIsolated(const std::function<std::string()>& task, double limit);

/// Parses numbers separated by whitespace; also nan and inf.
std::vector<double> numbersOf(const std::string& text);

}  // namespace spring_pendulum::benchmark

// Runs the cases of a study on threads and ranks and writes their table.
#pragma once

#include "sweep/case_counter.hpp"
#include "sweep/study/study.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <thread>

namespace spring_pendulum::sweep {

struct SweepOptions {
  std::string output;                                                        ///< the table
  std::int64_t threads = std::max(1U, std::thread::hardware_concurrency());  ///< of this process
  std::int64_t shard = 1;                                                    ///< counted from 1
  std::int64_t shards = 1;
  bool plot = false;
};

/// Returns the path of the picture of a table.
std::string picturePath(const std::string& output);

/// Makes a Run of each case, which checks its input.
/// \throws InputError naming the first case with bad input
void checkCases(const Study& study, std::int64_t threads);

/// Runs all cases that are not in the journal and, if none is left to other shards, writes the table.
/// \returns the exit status; 0 also if cases diverged
int runSweep(const Study& study, const SweepOptions& options, CaseCounter& counter);

}  // namespace spring_pendulum::sweep

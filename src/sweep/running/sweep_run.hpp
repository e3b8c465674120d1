// Runs the cases of a study on threads and ranks and writes their table.
#pragma once

#include <cstdint>
#include <string>

#include "sweep/running/dispatcher.hpp"
#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

struct SweepOptions {
  std::string output;        ///< the table
  std::int64_t threads = 0;  ///< of this process; 0: one per processor core
  std::int64_t shard = 1;    ///< counted from 1
  std::int64_t shards = 1;
  bool plot = false;
};

/// Returns the path of the pictures of a table, without extension.
std::string picturePath(const std::string& output);

/// Runs all cases that no journal holds and, if none is left to other shards, writes the table.
/// Rank 0 meets the others when everything is checked; the others have met it before.
/// \returns the exit status; 0 also if cases diverged
int runSweep(const Study& study, const SweepOptions& options, Dispatcher& dispatcher);

}  // namespace spring_pendulum::sweep

// The order in which cases are run: batches of some 50 ms, the longest first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// All cases of a study in batches; the same for every rank and shard.
struct Schedule {
  std::vector<std::vector<std::int64_t>> batches;
  std::vector<std::int32_t> scene_of;  ///< for each case; -1: shares no reference run
};

/// Checks every case and sorts the cases. Cases of one scene follow each other, so few reference runs
/// are kept at a time.
/// \throws InputError naming the first case with bad input
Schedule makeSchedule(const Study& study, int threads);

}  // namespace spring_pendulum::sweep

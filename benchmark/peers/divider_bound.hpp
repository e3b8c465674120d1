// A lower bound for every method: each spring force needs one square root and one division, whose
// throughput is limited by the divider of the processor.
#pragma once

namespace spring_pendulum::benchmark {

/// Least time in ns of 1/sqrt(q) in double precision for data in the first-level cache, with the
/// vector flags of the baselines.
double dividerBound();

}  // namespace spring_pendulum::benchmark

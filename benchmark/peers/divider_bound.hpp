// What no method can go below: every spring force needs one square root and one division, and the
// processor's divider does nothing faster than this.
#pragma once

namespace spring_pendulum::benchmark {

/// ns for 1/sqrt(q) in double precision, over numbers in the first-level cache, with the vector
/// flags of the baselines. Least of many runs.
double dividerBound();

}  // namespace spring_pendulum::benchmark

// The search for the largest step size that passes a test.
#pragma once

#include <functional>

namespace spring_pendulum {

/// Returns a step size rounded down to three significant digits.
double roundedDown(double step);

/// Returns the largest step size in s that passes, within 2 % and with three significant digits.
/// Tries a coarse grid first and then bisects. Smaller step sizes are tried as well and pass: 1, 2,
/// ..., 20 % below the result, and exactly 5 and 10 % below it.
/// \returns 0 if no step size of at least `least` s passes; infinity if all up to `most` s pass
double largestPassingStep(double first, double least, double most,
                          const std::function<bool(double)>& passes);

}  // namespace spring_pendulum

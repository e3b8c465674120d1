// Checks of arguments, made once per call of a public function.
#pragma once

#include <spring_pendulum/base/errors.hpp>

#include <cstddef>
#include <cstdint>

namespace spring_pendulum {

/// \throws InputError unless a state has as many particles as the chain
void requireSize(std::ptrdiff_t of_chain, std::ptrdiff_t of_state);

/// Checks the arguments of Integrator::advance.
/// \throws InputError like requireSize, and unless `time_step` is finite and positive and `steps`
///   is at least 0
void requireAdvance(std::ptrdiff_t of_chain, std::ptrdiff_t of_state, double time_step,
                    std::int64_t steps);

/// \throws InputError naming the value unless it is finite and above 0, or exactly 0 if `or_zero`
void requirePositive(const char* name, double value, const char* unit, bool or_zero = false);

/// \throws InputError naming the value unless it is at least 0
void requireAtLeastZero(const char* name, std::ptrdiff_t value);

}  // namespace spring_pendulum

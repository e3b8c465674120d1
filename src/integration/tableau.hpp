// Properties of Butcher tableaus. One step of an explicit Runge-Kutta method multiplies the solution of
// y' = λ y by its stability function R(hλ).
//
// Reference: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer
// 1996, section IV.2.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <string_view>

namespace spring_pendulum {

/// \param method name of the method, for the error
/// \throws InputError unless this is the tableau of an explicit method with finite coefficients
void checkTableau(std::string_view method, const ButcherTableau& tableau);

/// Returns R(z) - 1.
inline std::complex<double> stabilityIncrement(const ButcherTableau& tableau,
                                               std::complex<double> z) {
  std::array<std::complex<double>, ButcherTableau::kMaxStages> slopes{};
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    slopes[i] = z;
    for (std::size_t j = 0; j < i; ++j) slopes[i] += z * tableau.a[i][j] * slopes[j];
    sum += tableau.b[i] * slopes[i];
  }
  return sum;
}

/// Returns ln |R|.
/// \param increment R - 1
inline double growthOf(std::complex<double> increment) {
  return 0.5 * std::log1p(2.0 * increment.real() + std::norm(increment));
}

}  // namespace spring_pendulum

// Weighted sums over the stages of Radau IIA.
#pragma once

#include "integration/implicit/complex.hpp"
#include "integration/implicit/radau_coefficients.hpp"

#include <array>
#include <cstddef>

namespace spring_pendulum::radau {

inline double dot(const Row& a, const Row& b) {
  double sum = 0.0;
  for (std::size_t s = 0; s < kStages; ++s) sum += a[s] * b[s];
  return sum;
}

inline Complex dot(const ComplexRow& a, const Row& b) {
  Complex sum;
  for (std::size_t s = 0; s < kStages; ++s) sum = sum + b[s] * a[s];
  return sum;
}

inline double realPart(double a) {
  return a;
}
inline double realPart(Complex a) {
  return a.re;
}

/// Adds the real part of each factor times `value`.
template <typename Scalar>
void addTo(Row& row, const std::array<Scalar, kStages>& factors, Scalar value) {
  for (std::size_t s = 0; s < kStages; ++s) row[s] += realPart(factors[s] * value);
}

/// Returns the values of the Lagrange polynomials of the nodes at `time`, in step sizes.
/// \param with_start whether 0 is a node as well
inline Row lagrangeWeights(double time, bool with_start) {
  const Row& c = kNodes;
  Row weights;
  for (std::size_t i = 0; i < kStages; ++i) {
    weights[i] = with_start ? time / c[i] : 1.0;
    for (std::size_t j = 0; j < kStages; ++j) {
      if (j != i) weights[i] *= (time - c[j]) / (c[i] - c[j]);
    }
  }
  return weights;
}

}  // namespace spring_pendulum::radau

// The force of one damped spring, written once: the plain code and the SIMD kernels both call it,
// so both do the same arithmetic in the same order.
#pragma once

#include <cmath>

namespace spring_pendulum {

/// Kelvin-Voigt spring: a linear spring and a linear dashpot side by side.
struct SpringLaw {
  double stiffness = 50.0;   ///< k_s, N/m, at least 0
  double damping = 1.0;      ///< k_d, N·s/m, at least 0
  double rest_length = 1.0;  ///< L_0, m, at least 0
};

/// A vector in the plane of the motion.
template <typename Value>
struct PlaneVector {
  Value x;
  Value y;
};

/// 1/sqrt(q), and 0 for q = 0: a spring without length has no direction, hence no force.
inline double inverseSquareRoot(double q) {
  return q > 0.0 ? 1.0 / std::sqrt(q) : 0.0;
}

/// Force in N of a spring on the end it is seen from,
///
///     f = (k_s (L - L_0) + k_d w·r) r ,   L = |d| ,   r = d / L ,
///
/// evaluated as f = (k_s + (k_d (w·d)/L - k_s L_0) / L) d, which needs 1/L alone.
/// \param separation d = p_other - p_this, m
/// \param approach   w = v_other - v_this, m/s
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> springForce(const SpringLaw& law,
                                                             const PlaneVector<Value>& separation,
                                                             const PlaneVector<Value>& approach) {
  const Value square = separation.x * separation.x + separation.y * separation.y;
  const Value inverse_length = inverseSquareRoot(square);
  const Value dot = approach.x * separation.x + approach.y * separation.y;
  const Value inner = law.damping * (dot * inverse_length) - law.stiffness * law.rest_length;
  const Value factor = law.stiffness + inverse_length * inner;
  return {factor * separation.x, factor * separation.y};
}

/// The same, to the last bit, of a spring whose damping is 0 (as long as w·d is finite).
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> undampedSpringForce(
    const SpringLaw& law, const PlaneVector<Value>& separation) {
  const Value square = separation.x * separation.x + separation.y * separation.y;
  const Value inner = -(law.stiffness * law.rest_length) * inverseSquareRoot(square);
  const Value factor = law.stiffness + inner;
  return {factor * separation.x, factor * separation.y};
}

}  // namespace spring_pendulum

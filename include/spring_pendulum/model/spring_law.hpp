// The force of one damped spring, written once: the plain code and the SIMD kernels both call it,
// so both do the same arithmetic in the same order, with the same fused multiply-adds.
#pragma once

#include <spring_pendulum/model/export.hpp>

#include <cmath>

namespace SPRING_PENDULUM_API spring_pendulum {

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

/// a b + c, rounded once. Nothing else fuses: with -ffp-contract=off the compiler never does.
[[gnu::always_inline]] inline double fused(double a, double b, double c) {
  return std::fma(a, b, c);
}

/// 1/sqrt(q), and 0 for q = 0: a spring without length has no direction, hence no force.
[[gnu::always_inline]] inline double inverseSquareRoot(double q) {
  return q > 0.0 ? 1.0 / std::sqrt(q) : 0.0;
}

/// d·d, m²
template <typename Value>
[[gnu::always_inline]] inline Value squaredLength(const PlaneVector<Value>& separation) {
  return fused(separation.x, separation.x, separation.y * separation.y);
}

/// a·b
template <typename Value>
[[gnu::always_inline]] inline Value dotProduct(const PlaneVector<Value>& a,
                                               const PlaneVector<Value>& b) {
  return fused(a.x, b.x, a.y * b.y);
}

/// w·r, m/s: how fast a spring grows longer; 0 without length.
template <typename Value>
[[gnu::always_inline]] inline Value elongationRate(const PlaneVector<Value>& separation,
                                                   const PlaneVector<Value>& approach) {
  return dotProduct(approach, separation) * inverseSquareRoot(squaredLength(separation));
}

/// The force of a spring with w·d (m²/s) and 1/L (1/m) known.
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> springForce(const SpringLaw& law,
                                                             const PlaneVector<Value>& separation,
                                                             const Value& dot,
                                                             const Value& inverse_length) {
  const Value inner = fused(law.damping * dot, inverse_length, -(law.stiffness * law.rest_length));
  const Value factor = fused(inverse_length, inner, law.stiffness);
  return {factor * separation.x, factor * separation.y};
}

/// The same, to the last bit, of a spring whose damping is 0 (as long as w·d is finite).
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> undampedSpringForce(
    const SpringLaw& law, const PlaneVector<Value>& separation, const Value& inverse_length) {
  const Value factor = fused(inverse_length, -(law.stiffness * law.rest_length), law.stiffness);
  return {factor * separation.x, factor * separation.y};
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
  const Value inverse_length = inverseSquareRoot(squaredLength(separation));
  return springForce(law, separation, dotProduct(approach, separation), inverse_length);
}

/// The same, to the last bit, of a spring whose damping is 0 (as long as w·d is finite).
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> undampedSpringForce(
    const SpringLaw& law, const PlaneVector<Value>& separation) {
  return undampedSpringForce(law, separation, inverseSquareRoot(squaredLength(separation)));
}

}  // namespace spring_pendulum

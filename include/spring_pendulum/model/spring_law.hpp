// The force of one damped spring. Both the plain code and the SIMD kernels call these functions, so
// they do the same arithmetic in the same order, with the same fused multiply-adds.
#pragma once

#include <cmath>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Kelvin-Voigt element: a linear spring and a linear dashpot in parallel.
struct SpringLaw {
  double stiffness = 50.0;   ///< k_s, N/m, at least 0
  double damping = 1.0;      ///< k_d, N·s/m, at least 0
  double rest_length = 1.0;  ///< L_0, m, at least 0
};

inline bool operator==(const SpringLaw& a, const SpringLaw& b) {
  return a.stiffness == b.stiffness && a.damping == b.damping && a.rest_length == b.rest_length;
}

/// A vector in the plane of the motion.
template <typename Value>
struct PlaneVector {
  Value x;
  Value y;
};

/// Returns a b + c, rounded once. With -ffp-contract=off, the compiler fuses nothing else.
[[gnu::always_inline]] inline double fused(double a, double b, double c) {
  return std::fma(a, b, c);
}

/// Returns 1/sqrt(q), or 0 for q = 0: a spring of length 0 has no direction and exerts no force.
[[gnu::always_inline]] inline double inverseSquareRoot(double q) {
  return q > 0.0 ? 1.0 / std::sqrt(q) : 0.0;
}

/// Returns a·b.
template <typename Value>
[[gnu::always_inline]] inline Value dotProduct(const PlaneVector<Value>& a,
                                               const PlaneVector<Value>& b) {
  return fused(a.x, b.x, a.y * b.y);
}

/// Returns the length L = |d| in m, with the same bits on every machine: std::hypot rounds
/// differently in different C libraries.
inline double lengthOf(const PlaneVector<double>& separation) {
  return std::sqrt(dotProduct(separation, separation));
}

/// Returns 1/L, 1/m.
template <typename Value>
[[gnu::always_inline]] inline Value inverseLength(const PlaneVector<Value>& separation) {
  return inverseSquareRoot(dotProduct(separation, separation));
}

/// Returns the elongation rate w·r, m/s; 0 for a spring of length 0.
template <typename Value>
[[gnu::always_inline]] inline Value elongationRate(const PlaneVector<Value>& separation,
                                                   const PlaneVector<Value>& relative_velocity) {
  return dotProduct(relative_velocity, separation) * inverseLength(separation);
}

/// Returns the force of a spring from given w·d (m²/s) and 1/L (1/m); see below.
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> springForce(const SpringLaw& law,
                                                             const PlaneVector<Value>& separation,
                                                             const Value& dot,
                                                             const Value& inverse_length) {
  const Value inner = fused(law.damping * dot, inverse_length, -(law.stiffness * law.rest_length));
  const Value factor = fused(inverse_length, inner, law.stiffness);
  return {factor * separation.x, factor * separation.y};
}

/// The force for damping 0. The same bits as springForce if w·d is finite.
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> undampedSpringForce(
    const SpringLaw& law, const PlaneVector<Value>& separation, const Value& inverse_length) {
  const Value factor = fused(inverse_length, -(law.stiffness * law.rest_length), law.stiffness);
  return {factor * separation.x, factor * separation.y};
}

/// Force in N of a spring on the particle at one of its ends,
///
///     f = (k_s (L - L_0) + k_d w·r) r ,   L = |d| ,   r = d / L ,
///
/// evaluated as f = (k_s + (k_d (w·d)/L - k_s L_0) / L) d, which needs only 1/L.
/// \param separation        d = p_other - p_this, m
/// \param relative_velocity w = v_other - v_this, m/s
template <typename Value>
[[gnu::always_inline]] inline PlaneVector<Value> springForce(
    const SpringLaw& law, const PlaneVector<Value>& separation,
    const PlaneVector<Value>& relative_velocity) {
  return springForce(law, separation, dotProduct(relative_velocity, separation),
                     inverseLength(separation));
}

}  // namespace spring_pendulum
#pragma GCC visibility pop

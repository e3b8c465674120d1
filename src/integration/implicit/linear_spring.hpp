// Linearisation of a spring whose tension is an additional unknown.
//
// With the direction r, the separation d, the relative velocity w, the length L and the tension T, the
// force on one end is f = T r. Its change is
//
//     df = r dT + e (I - r rᵀ) dd ,   e = T / L ,
//     dT = a · dd + k_d r · dw ,      a = k_s r + k_d (w - (w · r) r) / L .
//
// Substituting dT into df gives the derivatives df/dd = r aᵀ + e (I - r rᵀ) and df/dw = k_d r rᵀ.
#pragma once

#include <spring_pendulum/model/spring_law.hpp>

namespace spring_pendulum {

struct LinearSpring {
  PlaneVector<double> r{};  ///< direction; 0 for a spring of length 0
  PlaneVector<double> a{};  ///< derivative of the tension by the separation, N/m
  double e = 0.0;           ///< geometric stiffness, N/m

  /// Returns dT in N for changes of the separation and the relative velocity.
  double tensionChange(double damping, const PlaneVector<double>& separation,
                       const PlaneVector<double>& relative_velocity) const {
    return (a.x * separation.x + a.y * separation.y) +
           damping * (r.x * relative_velocity.x + r.y * relative_velocity.y);
  }

  /// Returns (df/dd) d.
  PlaneVector<double> stiffnessTimes(const PlaneVector<double>& d) const {
    const double along = r.x * d.x + r.y * d.y;
    const double change = (a.x * d.x + a.y * d.y) - e * along;
    return {e * d.x + change * r.x, e * d.y + change * r.y};
  }
};

/// Returns the tension k_s (L - L_0) + k_d w·r, N.
inline double springTension(const SpringLaw& law, const PlaneVector<double>& separation,
                            const PlaneVector<double>& relative_velocity) {
  const double square = separation.x * separation.x + separation.y * separation.y;
  const double inverse_length = inverseSquareRoot(square);
  const double dot = relative_velocity.x * separation.x + relative_velocity.y * separation.y;
  return law.stiffness * (square * inverse_length - law.rest_length) +
         law.damping * (dot * inverse_length);
}

inline LinearSpring linearSpring(const SpringLaw& law, const PlaneVector<double>& separation,
                                 const PlaneVector<double>& relative_velocity, double tension) {
  const double square = separation.x * separation.x + separation.y * separation.y;
  const double inverse_length = inverseSquareRoot(square);
  const PlaneVector<double> r{separation.x * inverse_length, separation.y * inverse_length};
  const double rate = relative_velocity.x * r.x + relative_velocity.y * r.y;
  const double turn = law.damping * inverse_length;
  return {r,
          {law.stiffness * r.x + turn * (relative_velocity.x - rate * r.x),
           law.stiffness * r.y + turn * (relative_velocity.y - rate * r.y)},
          tension * inverse_length};
}

}  // namespace spring_pendulum

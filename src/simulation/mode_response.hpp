// What a fixed-step method makes of one linear mode q'' + d q' + k q = 0.
//
// One step of size h multiplies (sqrt(k) q, q') by a 2×2 matrix P(h), whose powers tell all: the
// mode grows if P has an eigenvalue outside the unit circle, and gains energy if a power of P has a
// norm above 1. P is measured on the method itself: a single spring moved along its own direction
// is exactly linear, so two trial steps are enough, and no stability function has to be known.
//
// Reference: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer
// 1996, section IV.2.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>

#include <Eigen/Core>

#include <memory>

namespace spring_pendulum {

class ModeResponse {
 public:
  /// The mode is measured in units of its own time scale: what counts is `damping_ratio` alone,
  /// d / (2 sqrt(k)), and steps are given as s = h |λ| with the faster root λ of λ² + d λ + k = 0.
  /// \param damping_ratio at least 0; infinite for a dashpot without spring
  ModeResponse(const Method& method, double damping_ratio);

  /// P for a step s, in energy coordinates.
  Eigen::Matrix2d matrix(double s) const;

  /// Growth rate of the energy per unit of time 1/|λ|, 2 ln(spectral radius of P)/s; 0 if the mode
  /// does not grow.
  double growthRate(double s) const;

  /// Largest factor by which the first powers of P raise the energy, at least 1.
  double largestGain(double s) const;

 private:
  double stiffness_;  ///< in units of |λ|²
  std::unique_ptr<Integrator> integrator_;
};

/// |λ| in 1/s of the faster root of λ² + k_d μ λ + k_s μ = 0.
double fasterRoot(const SpringLaw& spring, double mode);

/// k_d μ / (2 sqrt(k_s μ)); infinite without stiffness.
double dampingRatio(const SpringLaw& spring, double mode);

}  // namespace spring_pendulum

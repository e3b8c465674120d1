// Proportional-integral control of the step size. Where stability limits the steps, the integral
// part damps the oscillation between accepted and rejected steps of purely proportional control.
//
//     h_new = h * safety * e^(-7/8k) * e_old^(1/4k)
//
// e is the estimated error divided by the allowed error, e = O(h^k). Powers are computed with
// correctly rounded operations and integer operations on the exponent, so step sizes are the same
// bits on every machine.
//
// Reference: K. Gustafsson, ACM Trans. Math. Softw. 17 (1991) 533-554, doi:10.1145/210232.210242;
// the exponents are near those of Hairer, Nørsett, Wanner, Solving ODEs I, section II.4, and
// Hairer, Wanner, Solving ODEs II, section IV.2.
#pragma once

namespace spring_pendulum {

/// Returns the k-th root of x with a relative error below 2e-5, enough for a step size. It divides
/// the binary logarithm, which it reads from the bits of x; the result is the same on every machine.
/// \param x at least 0; treated as 1e-300 if it is smaller and not 0
/// \param k 1..32
double root(double x, int k);

class StepSizeController {
 public:
  /// \param error_order k above, 1..32
  explicit StepSizeController(int error_order) : error_order_(error_order) {}

  /// Discards the history of errors.
  void restart() {
    previous_root_ = 1.0;
    after_rejection_ = false;
  }

  /// Whether a step with this error is accepted.
  static bool accepts(double error) { return error <= 1.0; }

  /// Returns the next step size to try, after a step of size h was accepted or rejected with this
  /// error. NaN counts as a very large error.
  double next(double h, double error);

 private:
  int error_order_;
  double previous_root_ = 1.0;    ///< e_old^(1/k)
  bool after_rejection_ = false;  ///< the next accepted step must not grow
};

}  // namespace spring_pendulum

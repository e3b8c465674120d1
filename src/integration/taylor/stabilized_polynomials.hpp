// Weights that make the sum of a Taylor series stable along the negative real axis.
// benchmark/derivations/stabilized_polynomials.py derives and explains them.
#pragma once

#include <array>
#include <cstddef>

namespace spring_pendulum {

/// The weights w_j of the terms j = 0..K of a Taylor series. The stability polynomial
/// R(z) = sum_j w_j z^j / j! agrees with exp(z) to order p.
struct StabilizedPolynomial {
  static constexpr std::size_t kMaxAdded = 7;

  int order;                                    ///< p; w_j = 1 up to it
  int terms;                                    ///< K
  double real_stability_limit;                  ///< |R(z)| <= 1 for real z from minus this to 0
  std::array<double, kMaxAdded - 1> weights;    ///< w_{p+1} to w_K
  std::array<double, kMaxAdded> error_weights;  ///< e_p to e_K: the error is sum_j e_j c_j h^j

  double weight(int term) const {
    if (term <= order) return 1.0;
    return term <= terms ? weights[static_cast<std::size_t>(term - order - 1)] : 0.0;
  }
  double errorWeight(int term) const {
    const bool counts = order <= term && term <= terms;
    return counts ? error_weights[static_cast<std::size_t>(term - order)] : 0.0;
  }
};

/// The polynomials of one order, with increasing number of terms. The first is the plain series.
struct StabilizedPolynomials {
  const StabilizedPolynomial* first;
  std::size_t count;

  const StabilizedPolynomial* begin() const { return first; }
  const StabilizedPolynomial* end() const { return first + count; }
};

/// \param order 4 or 8
StabilizedPolynomials stabilizedPolynomials(int order);

}  // namespace spring_pendulum

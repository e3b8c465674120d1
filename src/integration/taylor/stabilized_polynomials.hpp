// Weights that make the sum of a Taylor series stable along the negative real axis.
// benchmark/derivations/stabilized_polynomials.py derives them and says how.
#pragma once

#include <array>
#include <cstddef>

namespace spring_pendulum {

/// Term j of the series is summed with weight w_j, j = 0..K. The stability polynomial
/// R(z) = sum_j w_j z^j / j! agrees with exp(z) to order p.
struct StabilizedPolynomial {
  static constexpr std::size_t kMaxAdded = 7;

  int order;                                    ///< p; w_j = 1 up to it
  int terms;                                    ///< K
  double real_stability_limit;                  ///< |R| <= 1 from it to 0 on the negative real axis
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

/// All of one order, 4 or 8, by rising number of terms; the first is the plain series.
struct StabilizedPolynomials {
  const StabilizedPolynomial* first;
  std::size_t count;

  const StabilizedPolynomial* begin() const { return first; }
  const StabilizedPolynomial* end() const { return first + count; }
};

StabilizedPolynomials stabilizedPolynomials(int order);

}  // namespace spring_pendulum

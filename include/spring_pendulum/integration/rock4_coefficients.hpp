// Coefficients of the stabilised methods of order 4. benchmark/derivations/rock4_coefficients.py
// derives them and says how.
#pragma once

#include <array>
#include <cstddef>

namespace spring_pendulum {

/// A method of `stages` = n + 4 evaluations a step. From K_0 = z_n and K_1 = z_n + μ_1 h F(z_n),
///
///     K_j = K_{j-1} + κ_j (K_{j-2} - K_{j-1}) + μ_j h F(K_{j-1}) ,  j = 2..n ,
///
/// then four stages of an explicit Runge-Kutta method begin at K_n,
///
///     f_1 = F(K_n)                            f_2 = F(K_n + h a_21 f_1)
///     f_3 = F(K_n + h (a_31 f_1 + a_32 f_2))  f_4 = F(K_n + h (a_41 f_1 + a_42 f_2 + a_43 f_3))
///     z_{n+1} = K_n + h (b_1 f_1 + b_2 f_2 + b_3 f_3 + b_4 f_4)
///
/// and f_5 = F(z_{n+1}), which the next step begins with, gives the error h sum_i e_i f_i.
struct Rock4Coefficients {
  struct Recurrence {
    double mu;
    double kappa;
  };
  static constexpr std::size_t kMaxRecurrences = 26;

  int stages;
  double real_stability_limit;  ///< largest h|λ| on the negative real axis
  std::array<Recurrence, kMaxRecurrences> recurrences;
  std::array<double, 10> finish;  ///< a_21, a_31, a_32, a_41, a_42, a_43, b_1, b_2, b_3, b_4
  std::array<double, 5> error;    ///< e_i

  std::size_t recurrenceCount() const { return static_cast<std::size_t>(stages) - 4; }
};

/// By rising number of stages, 5 to 30.
const std::array<Rock4Coefficients, 15>& rock4Table();

}  // namespace spring_pendulum

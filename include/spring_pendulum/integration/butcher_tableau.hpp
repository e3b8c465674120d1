// An explicit Runge-Kutta method is its Butcher tableau:
//
//     k_i = F(z_n + h sum_{j<i} a_ij k_j)        z_{n+1} = z_n + h sum_i b_i k_i
//
// F is autonomous here, so the nodes c_i = sum_j a_ij are not needed. Tableaus are constexpr data;
// one engine runs all of them.
//
// Reference: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
// ed., Springer 1993, section II.1.
#pragma once

#include <array>
#include <cstddef>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Coefficients of an explicit method with at most `kMaxStages` stages. All entries of `a` on and
/// above the diagonal are 0.
struct ButcherTableau {
  static constexpr std::size_t kMaxStages = 16;
  std::size_t stages = 0;
  std::array<std::array<double, kMaxStages>, kMaxStages> a{};
  std::array<double, kMaxStages> b{};
};

/// Explicit Euler, order 1:
///
///     0 |
///     --+---
///       | 1
///
/// Stable for real hλ >= -2 and for no imaginary hλ: for lessons only, as undamped swinging grows at
/// every step size. L. Euler, Institutionum calculi integralis I, 1768, §650.
inline constexpr ButcherTableau kEulerTableau{1, {}, {1.0}};

/// Explicit midpoint rule, order 2:
///
///     0   |
///     1/2 | 1/2
///     ----+--------
///         | 0    1
///
/// Stable for real hλ >= -2 and for no imaginary hλ. C. Runge, Ueber die numerische Auflösung von
/// Differentialgleichungen, Math. Ann. 46 (1895) 167-178, doi:10.1007/BF01446807.
inline constexpr ButcherTableau kMidpointTableau{2, {{{}, {0.5}}}, {0.0, 1.0}};

/// The classical Runge-Kutta method, order 4:
///
///     0   |
///     1/2 | 1/2
///     1/2 | 0   1/2
///     1   | 0   0   1
///     ----+--------------------
///         | 1/6 1/3 1/3 1/6
///
/// Stable for real hλ >= -2.785 and imaginary |hλ| <= 2.828. W. Kutta, Beitrag zur näherungsweisen
/// Integration totaler Differentialgleichungen, Z. Math. Phys. 46 (1901) 435-453.
inline constexpr ButcherTableau kClassicalRungeKuttaTableau{
    4, {{{}, {0.5}, {0.0, 0.5}, {0.0, 0.0, 1.0}}}, {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0}};

}  // namespace spring_pendulum
#pragma GCC visibility pop

// The motion of a chain in extended precision, or with 113 bits for motions so chaotic that extended
// precision loses them. Shares no code with the library: Gragg-Bulirsch-Stoer extrapolation.
//
// Reference: Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, 1993, section II.9.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "support/scene.hpp"

namespace spring_pendulum::test {

#if __LDBL_MANT_DIG__ == 113
using Quad = long double;
#else
__extension__ typedef __float128 Quad;  // NOLINT(modernize-use-using): needs __extension__
#endif

/// Square root by two of Newton's iterations, from 53 bits.
template <typename Real>
Real squareRoot(Real x) {
  Real root = std::sqrt(static_cast<double>(x));
  if (!(root > 0)) return 0;
  for (int i = 0; i < 2; ++i) root = (root + x / root) / 2;
  return root;
}

/// \tparam kColumns of the extrapolation, whose order is twice as large
template <typename Real, int kColumns>
class ExtrapolatedMotion {
 public:
  explicit ExtrapolatedMotion(const Scene& scene) : chain_(scene.chain) {
    for (Eigen::Index i = 0; i < chain_.size(); ++i)
      for (int column = 0; column < 4; ++column) z_.push_back(scene.start.values()(i, column));
    slope_.resize(z_.size());
  }

  /// Continues with another drive.
  void drive(const Chain& chain) { chain_ = chain; }

  /// Returns whether `most_work`, the limit of the evaluations so far times particles, was enough.
  bool advance(double seconds, double most_work = HUGE_VAL) {
    for (Real left = seconds; left > 0;) {
      const bool last = step_ >= left;
      const Real h = last ? left : step_;
      const double error = std::max(static_cast<double>(extrapolate(h)) / kTolerance, 1e-30);
      const double factor = std::clamp(0.9 * std::pow(error, -1.0 / (2 * kColumns - 1)), 0.2, 4.0);
      work_ += kColumns * (kColumns + 2) * static_cast<double>(chain_.size());
      if (work_ > most_work) return false;
      if (error > 1.0) {
        step_ = h * std::min(factor, 0.8);
        continue;
      }
      z_ = table_[0];
      left = last ? Real(0) : left - h;
      if (!last || factor < 1.0) step_ = h * factor;
    }
    return true;
  }

  State state() const {
    State state(chain_.size());
    for (Eigen::Index i = 0; i < 4 * state.size(); ++i)
      state.values()(i / 4, i % 4) = static_cast<double>(z_[static_cast<std::size_t>(i)]);
    return state;
  }

  /// Largest distance of a particle from its true position, m.
  double errorOf(const State& state) const {
    double largest = 0.0;
    for (Eigen::Index i = 0; i < state.size(); ++i) {
      const std::size_t at = 4 * static_cast<std::size_t>(i);
      const Real dx = z_[at] - state.x()[i];
      const Real dy = z_[at + 1] - state.y()[i];
      largest = std::max(largest, static_cast<double>(squareRoot(dx * dx + dy * dy)));
    }
    return largest;
  }

 private:
  using Vector = std::vector<Real>;  // x, y, vx, vy of every particle
  static constexpr double kTolerance = kColumns == 16 ? 1e-22 : 1e-13;  // m

  void computeSlope(const Vector& z) {
    const SpringLaw& law = chain_.spring();
    for (std::size_t i = 0; i < z.size(); i += 4) {
      slope_[i] = z[i + 2];
      slope_[i + 1] = z[i + 3];
      slope_[i + 2] = 0;
      slope_[i + 3] = -Real(chain_.gravity());
    }
    for (std::size_t a = 0, b = 4; b < z.size(); a = b, b += 4) {
      const Real dx = z[b] - z[a], dy = z[b + 1] - z[a + 1];
      const Real length = squareRoot(dx * dx + dy * dy);
      if (!(length > 0)) continue;
      const Real rx = dx / length, ry = dy / length;
      const Real rate = (z[b + 2] - z[a + 2]) * rx + (z[b + 3] - z[a + 3]) * ry;
      const Real tension = law.stiffness * (length - law.rest_length) + law.damping * rate;
      const auto mass = [&](std::size_t at) {
        return Real(chain_.masses()[static_cast<Eigen::Index>(at / 4)]);
      };
      slope_[a + 2] += tension * rx / mass(a);
      slope_[a + 3] += tension * ry / mass(a);
      slope_[b + 2] -= tension * rx / mass(b);
      slope_[b + 3] -= tension * ry / mass(b);
    }
    for (std::size_t at = 0; at < z.size(); at += 4) {
      const Real rate = Real(chain_.airDrag()) / chain_.masses()[static_cast<Eigen::Index>(at / 4)];
      slope_[at + 2] -= rate * z[at + 2];
      slope_[at + 3] -= rate * z[at + 3];
    }
    for (const AppliedForce& applied : chain_.drive().forces) {
      const auto at = 4 * static_cast<std::size_t>(applied.particle);
      slope_[at + 2] += Real(applied.force.x) / chain_.masses()[applied.particle];
      slope_[at + 3] += Real(applied.force.y) / chain_.masses()[applied.particle];
    }
    std::fill(slope_.begin(), slope_.begin() + 4, Real(0));
    for (const HeldParticle& held : chain_.drive().held) {
      const auto at = 4 * static_cast<std::size_t>(held.particle);
      slope_[at] = z[at + 2];
      slope_[at + 1] = z[at + 3];
      slope_[at + 2] = held.acceleration.x;
      slope_[at + 3] = held.acceleration.y;
    }
  }

  /// Gragg's smoothed midpoint rule with n steps over a time h.
  Vector midpointRule(Real h, int n) {
    h /= n;
    Vector old = z_, now = z_;
    computeSlope(z_);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] += h * slope_[i];
    for (int s = 1; s < n; ++s) {
      computeSlope(now);
      for (std::size_t i = 0; i < now.size(); ++i) old[i] += 2 * h * slope_[i];
      old.swap(now);
    }
    computeSlope(now);
    for (std::size_t i = 0; i < now.size(); ++i) now[i] = (old[i] + now[i] + h * slope_[i]) / 2;
    return now;
  }

  /// Takes a step of size h into `table_[0]`. Returns how the last two columns differ, m; velocities x 0.05 s.
  Real extrapolate(Real h) {
    Vector before;
    for (int k = 0; k < kColumns; ++k) {
      before = table_[0];
      table_[k] = midpointRule(h, 2 * (k + 1));
      for (int j = k - 1; j >= 0; --j) {
        const Real ratio = Real(k + 1) / (j + 1), factor = 1 / (ratio * ratio - 1);
        for (std::size_t i = 0; i < z_.size(); ++i)
          table_[j][i] = table_[j + 1][i] + (table_[j + 1][i] - table_[j][i]) * factor;
      }
    }
    Real largest = 0;
    for (std::size_t i = 0; i < z_.size(); ++i) {
      const Real change = (table_[0][i] - before[i]) * (i % 4 < 2 ? Real(1) : Real(0.05));
      largest = std::max(largest, change < 0 ? -change : change);
    }
    return largest;
  }

  Chain chain_;
  Vector z_, slope_;
  std::array<Vector, kColumns> table_;
  Real step_ = 1e-6;   // s
  double work_ = 0.0;  // evaluations x particles
};

using PreciseMotion = ExtrapolatedMotion<Quad, 16>;

}  // namespace spring_pendulum::test

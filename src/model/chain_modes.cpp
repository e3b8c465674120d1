#include "model/chain_modes.hpp"

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kPrecision = 1e-4;            ///< relative precision of the largest eigenvalue
constexpr Eigen::Index kSwingingSprings = 10;  ///< number of springs that swing as a rigid body

/// The tridiagonal matrix B M^-1 B^T.
class SpringMatrix {
 public:
  explicit SpringMatrix(const Chain& chain) : inverse_masses_(chain.inverseMasses()) {}

  double diagonal(Eigen::Index i) const { return inverse_masses_[i] + inverse_masses_[i + 1]; }

  /// Whether all eigenvalues lie below `bound`: all pivots of bound·I - A are positive.
  bool isBelow(double bound) const {
    double pivot = bound - diagonal(0);
    for (Eigen::Index i = 1; i + 1 < inverse_masses_.size() && pivot > 0.0; ++i) {
      pivot = bound - diagonal(i) - inverse_masses_[i] * inverse_masses_[i] / pivot;
    }
    return pivot > 0.0;
  }

  double largestDiagonal() const {
    double largest = 0.0;
    for (Eigen::Index i = 0; i + 1 < inverse_masses_.size(); ++i) {
      largest = std::max(largest, diagonal(i));
    }
    return largest;
  }

  /// Bisects between the largest diagonal entry and twice this value, which bounds the eigenvalues
  /// because A is diagonally dominant after scaling by M.
  double largestEigenvalue() const {
    double least = largestDiagonal();
    double most = 2.0 * least;
    while (most - least > kPrecision * least) {
      const double middle = 0.5 * (least + most);
      (isBelow(middle) ? most : least) = middle;
    }
    return most;
  }

 private:
  AlignedNumbers::ConstView inverse_masses_;
};

}  // namespace

double largestSpringMode(const Chain& chain) {
  return chain.size() < 2 ? 0.0 : SpringMatrix(chain).largestEigenvalue();
}

double largestDampingRate(const Chain& chain) {
  const double springs = chain.spring().damping * largestSpringMode(chain);
  if (chain.airDrag() == 0.0) return springs;
  return springs + chain.airDrag() * chain.inverseMasses().maxCoeff();
}

double stiffestSpring(const Chain& chain) {
  return SpringMatrix(chain).largestDiagonal();
}

double slowSwing(const Chain& chain) {
  const double gravity = std::abs(chain.gravity());
  const double stiffness = chain.spring().stiffness;
  if (chain.size() < 2 || gravity == 0.0 || stiffness == 0.0) return 0.0;
  const Eigen::Index first = std::max<Eigen::Index>(chain.size() - kSwingingSprings, 1);
  double mass = chain.masses().tail(chain.size() - first).sum();  // beyond the spring
  double depth = 0.0;
  double moment = 0.0;   // sum m d
  double inertia = 0.0;  // sum m d²
  for (Eigen::Index i = first; i < chain.size(); ++i) {
    depth += chain.spring().rest_length + mass * gravity / stiffness;
    moment += chain.masses()[i] * depth;
    inertia += chain.masses()[i] * depth * depth;
    mass -= chain.masses()[i];
  }
  return std::sqrt(gravity * moment / inertia);
}

}  // namespace spring_pendulum

#include "model/chain_modes.hpp"

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

constexpr double kPrecision = 1e-4;            ///< relative precision of the largest eigenvalue
constexpr Eigen::Index kSwingingSprings = 10;  ///< number of springs that swing as a rigid body

using InverseMasses = AlignedNumbers::ConstView;

/// Diagonal entry of the tridiagonal matrix A = B M^-1 B^T. Beside it are the negative inverse masses.
double diagonal(const InverseMasses& inverse_masses, Eigen::Index i) {
  return inverse_masses[i] + inverse_masses[i + 1];
}

/// Whether all eigenvalues lie below `bound`: all pivots of bound·I - A are positive.
bool isBelow(const InverseMasses& inverse_masses, double bound) {
  double pivot = bound - diagonal(inverse_masses, 0);
  for (Eigen::Index i = 1; i + 1 < inverse_masses.size() && pivot > 0.0; ++i) {
    pivot = bound - diagonal(inverse_masses, i) - inverse_masses[i] * inverse_masses[i] / pivot;
  }
  return pivot > 0.0;
}

}  // namespace

// Bisects between the largest diagonal entry and twice this value, which bounds the eigenvalues
// because A is diagonally dominant after scaling by M.
double largestSpringMode(const Chain& chain) {
  if (chain.size() < 2) return 0.0;
  double least = stiffestSpring(chain);
  double most = 2.0 * least;
  while (most - least > kPrecision * least) {
    const double middle = 0.5 * (least + most);
    (isBelow(chain.inverseMasses(), middle) ? most : least) = middle;
  }
  return most;
}

double fastestVibration(const Chain& chain) {
  return std::sqrt(chain.spring().stiffness * largestSpringMode(chain));
}

double largestDampingRate(const Chain& chain) {
  const double springs = chain.spring().damping * largestSpringMode(chain);
  if (chain.airDrag() == 0.0) return springs;
  return springs + chain.airDrag() * chain.inverseMasses().maxCoeff();
}

double stiffestSpring(const Chain& chain) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i + 1 < chain.size(); ++i) {
    largest = std::max(largest, diagonal(chain.inverseMasses(), i));
  }
  return largest;
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

#include "model/chain_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kPrecision = 1e-4;            ///< relative precision of the largest eigenvalue
constexpr Eigen::Index kSwingingSprings = 10;  ///< number of springs that swing as a rigid body

/// Whether all eigenvalues of A = B M^-1 B^T lie below `bound`: all pivots of bound·I - A are positive. A is
/// tridiagonal, with the negative inverse masses beside its diagonal.
bool isBelow(const AlignedNumbers::ConstView& inverse, double bound) {
  double pivot = std::numeric_limits<double>::infinity();
  for (Eigen::Index i = 0; i + 1 < inverse.size() && pivot > 0.0; ++i) {
    pivot = bound - (inverse[i] + inverse[i + 1]) - inverse[i] * inverse[i] / pivot;
  }
  return pivot > 0.0;
}

}  // namespace

// Bisects between the largest diagonal entry and twice this value, which bounds the eigenvalues
// because A is diagonally dominant after scaling by M.
double largestSpringMode(const Chain& chain) {
  if (chain.size() < 2) return 0.0;
  double least = stiffestSpring(chain);
  double most = std::min(2.0 * least, std::numeric_limits<double>::max());
  while (most - least > kPrecision * least) {
    const double middle = 0.5 * least + 0.5 * most;  // the sum could overflow
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
  const Eigen::Index springs = chain.size() - 1;
  if (springs == 0) return 0.0;
  return (chain.inverseMasses().head(springs) + chain.inverseMasses().tail(springs)).maxCoeff();
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

#include "model/chain_modes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kPrecision = 1e-4;
constexpr Eigen::Index kSwingingSprings = 10;

/// W_i of spring i, the weight of all particles beyond it in N, and L_i, its length at rest in m.
struct HangingSprings {
  explicit HangingSprings(const Chain& chain) : weights(chain.size() - 1), lengths(weights.size()) {
    double weight = 0.0;
    for (Eigen::Index i = weights.size() - 1; i >= 0; --i) {
      weight += chain.masses()[i + 1] * std::abs(chain.gravity());
      weights[i] = weight;
      lengths[i] = chain.spring().rest_length + weight / chain.spring().stiffness;
    }
  }

  Eigen::VectorXd weights;
  Eigen::VectorXd lengths;
};

/// The matrix D^(1/2) B M^-1 B^T D^(1/2) with a weight D_i for each spring.
class SpringMatrix {
 public:
  SpringMatrix(const Chain& chain, const Eigen::VectorXd& weights)
      : inverse_masses_(chain.inverseMasses()), weights_(weights) {}

  double diagonal(Eigen::Index i) const {
    return weights_[i] * (inverse_masses_[i] + inverse_masses_[i + 1]);
  }

  /// Square of the entry that couples springs i - 1 and i.
  double couplingSquared(Eigen::Index i) const {
    return weights_[i - 1] * inverse_masses_[i] * weights_[i] * inverse_masses_[i];
  }

  /// Whether all eigenvalues lie below `bound`: all pivots of bound·I - A are positive.
  bool isBelow(double bound) const {
    double pivot = bound - diagonal(0);
    for (Eigen::Index i = 1; i < weights_.size() && pivot > 0.0; ++i) {
      pivot = bound - diagonal(i) - couplingSquared(i) / pivot;
    }
    return pivot > 0.0;
  }

  /// Bisection between the largest diagonal entry and twice that, as A is diagonally dominant after
  /// scaling by M and D.
  double largestEigenvalue() const {
    double least = 0.0;
    for (Eigen::Index i = 0; i < weights_.size(); ++i) least = std::max(least, diagonal(i));
    double most = 2.0 * least;
    while (most - least > kPrecision * least) {
      const double middle = 0.5 * (least + most);
      (isBelow(middle) ? most : least) = middle;
    }
    return most;
  }

 private:
  const Eigen::VectorXd& inverse_masses_;
  const Eigen::VectorXd& weights_;
};

bool swings(const Chain& chain) {
  return chain.size() > 1 && chain.gravity() != 0.0 && chain.spring().stiffness > 0.0;
}

}  // namespace

double largestSpringMode(const Chain& chain) {
  if (chain.size() < 2) return 0.0;
  return SpringMatrix(chain, Eigen::VectorXd::Ones(chain.size() - 1)).largestEigenvalue();
}

double fastestSwing(const Chain& chain) {
  if (!swings(chain)) return 0.0;
  const HangingSprings springs(chain);
  const Eigen::VectorXd stiffness = springs.weights.cwiseQuotient(springs.lengths);
  return std::sqrt(SpringMatrix(chain, stiffness).largestEigenvalue());
}

double slowSwing(const Chain& chain) {
  if (!swings(chain)) return 0.0;
  const HangingSprings springs(chain);
  double depth = 0.0;
  double moment = 0.0;   // sum m d
  double inertia = 0.0;  // sum m d²
  const Eigen::Index end = springs.lengths.size();
  for (Eigen::Index i = std::max<Eigen::Index>(end - kSwingingSprings, 0); i < end; ++i) {
    depth += springs.lengths[i];
    moment += chain.masses()[i + 1] * depth;
    inertia += chain.masses()[i + 1] * depth * depth;
  }
  return std::sqrt(std::abs(chain.gravity()) * moment / inertia);
}

}  // namespace spring_pendulum

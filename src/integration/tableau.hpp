// Properties of Butcher tableaus. The algebraic order conditions are one for each rooted tree t:
//
//     sum_i b_i Phi_i(t) = 1 / gamma(t)
//
// One step of an explicit Runge-Kutta method multiplies the solution of y' = λ y by its stability
// function R(hλ).
//
// References: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed.,
// Springer 1993, theorem II.2.13; E. Hairer, G. Wanner, the same II, 2nd ed., Springer 1996, section IV.2.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// \param method name of the method, for the error
/// \throws InputError unless this is the tableau of an explicit method with finite coefficients
void checkTableau(std::string_view method, const ButcherTableau& tableau);

/// Returns R(z) - 1.
inline std::complex<double> stabilityIncrement(const ButcherTableau& tableau,
                                               std::complex<double> z) {
  std::array<std::complex<double>, ButcherTableau::kMaxStages> slopes{};
  std::complex<double> sum = 0.0;
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    slopes[i] = z;
    for (std::size_t j = 0; j < i; ++j) slopes[i] += z * tableau.a[i][j] * slopes[j];
    sum += tableau.b[i] * slopes[i];
  }
  return sum;
}

/// Returns ln |R|.
/// \param increment R - 1
inline double growthOf(std::complex<double> increment) {
  return 0.5 * std::log1p(2.0 * increment.real() + std::norm(increment));
}

/// A rooted tree as the list of its root's subtrees.
struct Tree {
  std::vector<Tree> branches;
  int order = 1;                       ///< number of nodes
  double densities_of_branches = 1.0;  ///< product

  /// The density gamma.
  double density() const { return order * densities_of_branches; }
};

/// Appends every tree with `order` nodes to `trees`. Branches are chosen from `smaller`, in its
/// order, starting at index `first`; `partial` has the branches chosen so far.
inline void growTrees(const std::vector<Tree>& smaller, std::size_t first, int order,
                      const Tree& partial, std::vector<Tree>& trees) {
  if (partial.order == order) return trees.push_back(partial);
  for (std::size_t i = first; i < smaller.size(); ++i) {
    if (partial.order + smaller[i].order > order) break;
    Tree next = partial;
    next.branches.push_back(smaller[i]);
    next.order += smaller[i].order;
    next.densities_of_branches *= smaller[i].density();
    growTrees(smaller, i, order, next, trees);
  }
}

/// Returns all rooted trees with up to `order` nodes, smallest first. There are 1, 1, 2, 4, 9, 20,
/// 48, 115, ... trees with 1, 2, 3, ... nodes.
inline std::vector<Tree> rootedTrees(int order) {
  std::vector<Tree> trees{Tree{}};
  for (int nodes = 2; nodes <= order; ++nodes) {
    std::vector<Tree> grown;
    growTrees(trees, 0, nodes, Tree{}, grown);
    trees.insert(trees.end(), grown.begin(), grown.end());
  }
  return trees;
}

/// Returns Phi_i(t) of every stage i.
inline std::vector<double> elementaryWeights(const ButcherTableau& tableau, const Tree& tree) {
  std::vector<double> weights(tableau.stages, 1.0);
  for (const Tree& branch : tree.branches) {
    const std::vector<double> inner = elementaryWeights(tableau, branch);
    for (std::size_t i = 0; i < tableau.stages; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < i; ++j) sum += tableau.a[i][j] * inner[j];
      weights[i] *= sum;
    }
  }
  return weights;
}

/// Returns the largest violation of a condition up to `order`, with the weights `b`.
template <typename Weights>
double orderConditionResidual(const ButcherTableau& tableau, const Weights& b, int order) {
  double largest = 0.0;
  for (const Tree& tree : rootedTrees(order)) {
    const std::vector<double> weights = elementaryWeights(tableau, tree);
    double sum = 0.0;
    for (std::size_t i = 0; i < tableau.stages; ++i) sum += b[i] * weights[i];
    largest = std::max(largest, std::abs(sum - 1.0 / tree.density()));
  }
  return largest;
}

}  // namespace spring_pendulum

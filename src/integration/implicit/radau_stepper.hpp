// Radau IIA of order 9 (five stages, L-stable) for chains with very light particles. The tension T of
// every spring is an unknown in addition to positions and velocities:
//
//     q' = v      m v' = sum of T r + m g      0 = k_s (L - L_0) + k_d L' - T
//
// An ordinary Newton iteration linearises the force of a dashpot about one direction of the spring.
// When the spring turns within the step, the linearised dashpot pushes a light particle sideways.
// The iteration then contracts with (k_d/m) h (ωh)², where ω is the angular velocity of the spring.
// Here, the force at a stage is the current iterate of T along the direction of the spring at that
// stage; only the equation for T is linearised about the direction in the middle of the step. This
// iteration contracts with about ωh, whatever the mass. Eliminating the tensions leaves three
// systems as in chain_solver.hpp, a real one and two complex ones.
//
// The positions at the stages follow from the velocities, q_i = q_0 + h sum_j a_ij v_j, so the
// unknowns of these systems are velocities. The error estimate is the embedded formula filtered by
// (I - q J)⁻¹. The error is controlled per unit step, which keeps vibrating light particles within
// the tolerance. The dense output is the collocation polynomial.
//
// Use this method for k_d/m above about 1e4/s. Without light particles the Taylor methods need less
// time, as every method has to resolve undamped vibration.
//
// References: E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer
// 1996, sections IV.5 and IV.8; the same, J. Comput. Appl. Math. 111 (1999) 93-111,
// doi:10.1016/S0377-0427(99)00134-X.
#pragma once

#include "integration/error_control/error_estimating_stepper.hpp"
#include "integration/implicit/chain_solver.hpp"
#include "integration/implicit/complex.hpp"
#include "integration/implicit/linear_spring.hpp"
#include "integration/implicit/radau_coefficients.hpp"
#include "integration/work.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace spring_pendulum {

class RadauStepper final : public ErrorEstimatingStepper {
 public:
  RadauStepper(const Chain& chain, double tolerance,
               const ChainKernels& kernels = fastestChainKernels());

  double workPerEvaluation() const override {
    return kRadauTime.of(chain_.size()) / kTaylorTime.of(chain_.size());
  }
  std::optional<double> tensionAt(Eigen::Index spring, double fraction) const override {
    return radau::dot(radau::lagrangeWeights(fraction, false),
                      stages_.tensions[static_cast<std::size_t>(spring)]);
  }

 private:
  using Row = radau::Row;
  /// Differences x, y, vx, vy between the state of a particle at each stage and at the beginning of
  /// the step.
  using Increments = std::array<Row, 4>;
  /// Components x and y of a force at each stage, N.
  using Forces = std::array<Row, 2>;
  /// The collocation polynomial: values at the stages.
  struct Collocation {
    explicit Collocation(Eigen::Index size)
        : particles(static_cast<std::size_t>(size)), tensions(static_cast<std::size_t>(size)) {}
    std::vector<Increments> particles;
    std::vector<Row> tensions;
  };
  /// One linear system. `unknowns` (x, y) holds its right-hand side and, after `solve`, its solution.
  template <typename Scalar>
  struct System {
    System(const Chain& chain, const radau::Eigenvalue<Scalar>& coefficients)
        : eigenvalue(coefficients), solver(chain) {
      unknowns.fill(std::vector<Scalar>(static_cast<std::size_t>(chain.size())));
    }
    void factor(const std::vector<LinearSpring>& springs, double h) {
      q = h * reciprocal(eigenvalue.value);
      solver.factor(springs, q);
    }
    void setRightHandSide(std::size_t i, double mass, const Increments& increments,
                          const Forces& forces) {
      for (std::size_t c = 0; c < 2; ++c)
        unknowns[c][i] = q * radau::dot(eigenvalue.left, forces[c]) -
                         mass * radau::dot(eigenvalue.left, increments[2 + c]);
    }
    void solve() { solver.solve(unknowns[0].data(), unknowns[1].data()); }
    /// Adds this system's contribution to the change of a particle's stages.
    void addChange(std::size_t i, Increments& change) const {
      for (std::size_t c = 0; c < 2; ++c) {
        radau::addTo(change[2 + c], eigenvalue.right, unknowns[c][i]);
        radau::addTo(change[c], eigenvalue.right, q * unknowns[c][i]);
      }
    }

    const radau::Eigenvalue<Scalar>& eigenvalue;
    ChainSolver<Scalar> solver;
    Scalar q{};  ///< h / eigenvalue, s
    std::array<std::vector<Scalar>, 2> unknowns;
  };
  /// Position and velocity of the right end of a spring relative to its left end.
  struct Ends {
    PlaneVector<double> separation;
    PlaneVector<double> relative_velocity;
  };

  void prepare(bool restarted) override;
  double attempt(double h) override;
  const StateBuffer& stateInside(double fraction) const override;

  static Ends endsOf(std::size_t spring, const StateBuffer& state);
  Ends endsOf(std::size_t spring, const Ends& start, std::size_t stage) const;
  double tensionOf(const Ends& ends) const {
    return springTension(chain_.spring(), ends.separation, ends.relative_velocity);
  }

  /// Air drag on a particle, N·s/m; 0 if it is held.
  double dragOn(std::size_t particle) const {
    return chain_.isHeld(static_cast<Eigen::Index>(particle)) ? 0.0 : chain_.airDrag();
  }
  /// Sets an initial guess of the stages: the extrapolated polynomial of the last step.
  void predict(double h);
  /// Sets the stages of a particle without springs: exact for P_1, else a guess that heavy drag slows.
  void moveWithoutSprings(std::size_t particle, double h);
  void linearise();
  /// Solves for the stages with a simplified Newton iteration.
  /// \returns whether it converged
  bool solveStages(double h);
  /// Computes the right-hand sides of all systems, and the tensions from the spring law.
  void computeResiduals();
  /// Computes the tensions of a spring and its forces on its left particle, at all stages.
  Forces springForces(std::size_t spring);
  LargestChange updateStages();
  /// Returns the largest estimated error of a coordinate, m.
  double estimateError(double h);
  /// Returns one estimate of the error and stores the error of each particle in `change_`.
  /// \param corrected whether to evaluate the slope at the start plus the first estimate
  double filteredError(bool corrected);
  PlaneVector<double> startForce(std::size_t spring, bool corrected) const;
  /// Takes an explicit Euler step, for a collision, where no polynomial describes the motion.
  double stepExplicitly(double h);
  void setEndFromLastStage();

  double allowed_rate_;  ///< error per unit of time, m/s
  Collocation stages_;
  Collocation previous_;
  double previous_length_ = 0.0;  ///< size of the previous step; 0: none
  std::vector<LinearSpring> springs_;
  System<double> real_;
  std::array<System<Complex>, 2> pairs_;
  /// Change of the state in the step, or the estimated error; after the step, the state inside it.
  mutable StateBuffer change_;
};

}  // namespace spring_pendulum

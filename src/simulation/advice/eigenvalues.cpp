#include "simulation/advice/eigenvalues.hpp"

#include "base/checks.hpp"
#include "integration/implicit/linear_spring.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>

namespace spring_pendulum {
namespace {

/// Adds the derivative of the force of a spring to the rows of one of its particles. Unknowns are
/// numbered without the fixed particle, which has the index -1.
void addForce(Eigen::MatrixXd& jacobian, Eigen::Index row, Eigen::Index column,
              const Eigen::Matrix2d& stiffness, const Eigen::Matrix2d& damping) {
  if (row < 0 || column < 0) return;
  const Eigen::Index half = jacobian.rows() / 2;
  jacobian.block<2, 2>(half + 2 * row, 2 * column) += stiffness;
  jacobian.block<2, 2>(half + 2 * row, half + 2 * column) += damping;
}

}  // namespace

std::vector<std::complex<double>> eigenvalues(const Chain& chain, const State& state) {
  requireSize(chain.size(), state.size());
  if (!state.values().allFinite()) throw InputError("eigenvalues of a state that is not finite");
  const Eigen::Index half = 2 * (chain.size() - 1);
  Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(2 * half, 2 * half);
  jacobian.topRightCorner(half, half).setIdentity();
  for (Eigen::Index i = 0; i + 1 < chain.size(); ++i) {
    const PlaneVector<double> separation{state.x()[i + 1] - state.x()[i],
                                         state.y()[i + 1] - state.y()[i]};
    const PlaneVector<double> relative_velocity{state.vx()[i + 1] - state.vx()[i],
                                                state.vy()[i + 1] - state.vy()[i]};
    const LinearSpring spring =
        linearSpring(chain.spring(), separation, relative_velocity,
                     springTension(chain.spring(), separation, relative_velocity));
    const Eigen::Vector2d r(spring.r.x, spring.r.y);
    const Eigen::Vector2d a(spring.a.x, spring.a.y);
    const Eigen::Matrix2d stiffness =
        r * (a - spring.e * r).transpose() + spring.e * Eigen::Matrix2d::Identity();
    const Eigen::Matrix2d damping = chain.spring().damping * r * r.transpose();
    for (const Eigen::Index end : {i, i + 1}) {
      const Eigen::Index other = 2 * i + 1 - end;
      const double weight = chain.inverseMasses()[end];
      addForce(jacobian, end - 1, other - 1, weight * stiffness, weight * damping);
      addForce(jacobian, end - 1, end - 1, -weight * stiffness, -weight * damping);
    }
  }
  for (Eigen::Index i = 1; i < chain.size(); ++i) {
    const Eigen::Index row = half + 2 * (i - 1);
    jacobian.block<2, 2>(row, row).diagonal().array() -= chain.airDrag() * chain.inverseMasses()[i];
  }
  std::vector<std::complex<double>> result(static_cast<std::size_t>(2 * half));
  if (result.empty()) return result;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(jacobian, false);
  for (Eigen::Index i = 0; i < 2 * half; ++i) {
    result[static_cast<std::size_t>(i)] = solver.eigenvalues()[i];
  }
  return result;
}

}  // namespace spring_pendulum

#include <spring_pendulum/model/dynamics.hpp>

namespace spring_pendulum {

PlaneVector<double> springForceOn(const Chain& chain, const State& state, Eigen::Index i) {
  const PlaneVector<double> separation{state.x()[i + 1] - state.x()[i],
                                       state.y()[i + 1] - state.y()[i]};
  const PlaneVector<double> approach{state.vx()[i + 1] - state.vx()[i],
                                     state.vy()[i + 1] - state.vy()[i]};
  return springForce(chain.spring(), separation, approach);
}

void computeAccelerations(const Chain& chain, const State& state, PlaneVectors& accelerations) {
  const Eigen::Index size = chain.size();
  accelerations.resize(size, 2);
  accelerations.row(0).setZero();
  PlaneVector<double> left = size > 1 ? springForceOn(chain, state, 0) : PlaneVector<double>{};
  for (Eigen::Index i = 1; i < size; ++i) {
    const bool free_end = i + 1 == size;
    const auto right = free_end ? PlaneVector<double>{} : springForceOn(chain, state, i);
    const double inverse_mass = chain.inverseMasses()[i];
    accelerations(i, 0) = (right.x - left.x) * inverse_mass;
    accelerations(i, 1) = fused(right.y - left.y, inverse_mass, -chain.gravity());
    left = right;
  }
}

}  // namespace spring_pendulum

// The right-hand side F of the equations of motion z' = F(z), and the forces in it.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <Eigen/Core>

namespace spring_pendulum {

/// N×2 matrix whose columns are the x and y components, one row a particle.
using PlaneVectors = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Force in N of spring i (joining particles i and i+1, counted from 0) on particle i.
PlaneVector<double> springForceOn(const Chain& chain, const State& state, Eigen::Index i);

/// Accelerations in m/s², N×2: (sum of spring forces)/m + (0, -g); 0 for the fixed first particle.
/// \param[out] accelerations resized only if its size is not N×2
void computeAccelerations(const Chain& chain, const State& state, PlaneVectors& accelerations);

}  // namespace spring_pendulum

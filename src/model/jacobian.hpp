// Derivatives of the spring forces: what an implicit method needs to know of the model.
//
// With d the separation and w the approach of the two ends, L = |d|, r = d/L and the force
// f = (k_s (L - L_0) + k_d w·r) r as in spring_law.hpp,
//
//     df/dd = e I + r bᵀ ,   e = (k_s (L - L_0) + k_d w·r) / L ,
//                            b = ((k_s L_0 - 2 k_d w·r) r + k_d w) / L
//     df/dw = k_d r rᵀ
//
// The second is symmetric; the first is not once the ends move sideways to each other, because the
// dashpot turns with the spring.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <Eigen/Core>

namespace spring_pendulum {

/// A 2×2 matrix a spring: row i holds xx, xy, yx, yy of the spring between particles i and i+1.
using SpringBlocks = Eigen::Matrix<double, Eigen::Dynamic, 4>;

/// State::values(), also of states whose columns lie further apart.
using StateView = Eigen::Ref<const State::Matrix, 0, Eigen::OuterStride<>>;

/// Derivatives of the force of spring i on particle i (springForceOn).
struct SpringJacobian {
  explicit SpringJacobian(Eigen::Index springs) : stiffness(springs, 4), damping(springs, 4) {}

  SpringBlocks stiffness;  ///< by the separation p_{i+1} - p_i, N/m
  SpringBlocks damping;    ///< by the approach v_{i+1} - v_i, N·s/m
};

/// \param state    N×4, columns x, y, vx, vy
/// \param[out] jacobian made for N-1 springs
void computeSpringJacobian(const SpringLaw& law, const StateView& state, SpringJacobian& jacobian);

}  // namespace spring_pendulum

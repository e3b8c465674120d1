#include "simulation/mode_response.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr double kDisplacement = 0x1p-10;  ///< in rest lengths; a power of two rounds least
constexpr double kRounding = 1e-11;        ///< growth a step that rounding may feign
constexpr int kPowers = 64;

/// The spring of a mode in units of its faster root: with λ = -1, or |λ| = 1.
SpringLaw normalised(double damping_ratio) {
  if (std::isinf(damping_ratio)) return {0.0, 1.0, 1.0};
  const SpringLaw spring{1.0, 2.0 * damping_ratio, 1.0};
  const double root = fasterRoot(spring, 1.0);
  return {1.0 / (root * root), spring.damping / root, 1.0};
}

double spectralRadius(const Eigen::Matrix2d& matrix) {
  const double half_trace = 0.5 * matrix.trace();
  const double determinant = matrix.determinant();
  const double discriminant = half_trace * half_trace - determinant;
  if (discriminant < 0.0) return std::sqrt(determinant);
  return std::abs(half_trace) + std::sqrt(discriminant);
}

}  // namespace

double fasterRoot(const SpringLaw& spring, double mode) {
  const double half_damping = 0.5 * spring.damping * mode;
  const double square = spring.stiffness * mode;
  const double discriminant = half_damping * half_damping - square;
  return discriminant > 0.0 ? half_damping + std::sqrt(discriminant) : std::sqrt(square);
}

double dampingRatio(const SpringLaw& spring, double mode) {
  return 0.5 * spring.damping * std::sqrt(mode) / std::sqrt(spring.stiffness);
}

ModeResponse::ModeResponse(const Method& method, double damping_ratio) {
  const SpringLaw spring = normalised(damping_ratio);
  stiffness_ = spring.stiffness;
  integrator_ = method.make(method, Chain(Eigen::Vector2d::Ones(), spring, 0.0), {});
}

Eigen::Matrix2d ModeResponse::matrix(double s) const {
  const double frequency = std::sqrt(stiffness_);
  const double unit = frequency > 0.0 ? frequency : 1.0;
  Eigen::Matrix2d response;
  for (const int column : {0, 1}) {
    State state(2);
    state.x()[1] = column == 0 ? 1.0 + kDisplacement : 1.0;
    state.vx()[1] = column == 0 ? 0.0 : unit * kDisplacement;
    integrator_->restart();
    integrator_->advance(state, s, 1);
    response(0, column) = (state.x()[1] - 1.0) / kDisplacement;
    response(1, column) = state.vx()[1] / (unit * kDisplacement);
  }
  return response;
}

double ModeResponse::growthRate(double s) const {
  const double growth = std::log(spectralRadius(matrix(s)));
  if (std::isnan(growth)) return std::numeric_limits<double>::infinity();
  return growth > kRounding ? 2.0 * growth / s : 0.0;
}

double ModeResponse::largestGain(double s) const {
  const Eigen::Matrix2d step = matrix(s);
  Eigen::Matrix2d power = step;
  double gain = 1.0;
  for (int n = 0; n < kPowers; ++n, power *= step) {
    const double norm = power.jacobiSvd().singularValues()[0];
    gain = std::max(gain, norm * norm);
  }
  return gain;
}

}  // namespace spring_pendulum

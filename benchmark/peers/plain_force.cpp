#include "plain_force.hpp"

#include <cmath>

namespace spring_pendulum::benchmark {

PlainForce::PlainForce(const Problem& problem)
    : size_(problem.size()),
      stiffness_(problem.stiffness),
      damping_(problem.damping),
      rest_length_(problem.rest_length),
      gravity_(problem.gravity),
      inverse_masses_(size_),
      force_x_(size_, 0.0),
      force_y_(size_, 0.0) {
  for (std::size_t i = 1; i < size_; ++i) inverse_masses_[i] = 1.0 / problem.masses[i];
}

void PlainForce::springForces(const double* state) {
  ++evaluations_;
  const std::size_t n = size_;
  const double* __restrict x = state;
  const double* __restrict y = state + n;
  const double* __restrict vx = state + 2 * n;
  const double* __restrict vy = state + 3 * n;
  double* __restrict fx = force_x_.data();
  double* __restrict fy = force_y_.data();
  const double stiffness = stiffness_;
  const double damping = damping_;
  const double rest_length = rest_length_;
#pragma GCC ivdep
  for (std::size_t i = 0; i < n - 1; ++i) {
    const double dx = x[i + 1] - x[i];
    const double dy = y[i + 1] - y[i];
    const double inverse_length = 1.0 / std::sqrt(dx * dx + dy * dy);
    const double dot = (vx[i + 1] - vx[i]) * dx + (vy[i + 1] - vy[i]) * dy;
    const double factor = stiffness * (1.0 - rest_length * inverse_length) +
                          damping * dot * inverse_length * inverse_length;
    fx[i] = factor * dx;
    fy[i] = factor * dy;
  }
}

void PlainForce::operator()(const double* state, double* derivative) {
  springForces(state);
  const std::size_t n = size_;
  const double* __restrict vx = state + 2 * n;
  const double* __restrict vy = state + 3 * n;
  const double* __restrict fx = force_x_.data();
  const double* __restrict fy = force_y_.data();
  const double* __restrict inverse_mass = inverse_masses_.data();
  double* __restrict dx = derivative;
  double* __restrict dy = derivative + n;
  double* __restrict ax = derivative + 2 * n;
  double* __restrict ay = derivative + 3 * n;
  const double gravity = gravity_;
#pragma GCC ivdep
  for (std::size_t i = 1; i < n; ++i) {  // the force after the last particle stays 0
    dx[i] = vx[i];
    dy[i] = vy[i];
    ax[i] = (fx[i] - fx[i - 1]) * inverse_mass[i];
    ay[i] = (fy[i] - fy[i - 1]) * inverse_mass[i] - gravity;
  }
  dx[0] = dy[0] = ax[0] = ay[0] = 0.0;
}

void PlainForce::interleaved(const double* state, double* derivative) {
  sorted_.resize(4 * size_);
  sorted_derivative_.resize(4 * size_);
  separate(size_, state, sorted_.data());
  (*this)(sorted_.data(), sorted_derivative_.data());
  interleave(size_, sorted_derivative_.data(), derivative);
}

void PlainForce::interleavedJacobian(const double* state, double* const* columns) const {
  const auto add = [&](std::size_t row, std::size_t column, double value) {
    columns[column][static_cast<std::ptrdiff_t>(row) - static_cast<std::ptrdiff_t>(column)] +=
        value;
  };
  for (std::size_t i = 1; i < size_; ++i) {
    add(4 * i, 4 * i + 2, 1.0);
    add(4 * i + 1, 4 * i + 3, 1.0);
  }
  for (std::size_t i = 0; i + 1 < size_; ++i) {
    const double* here = state + 4 * i;
    const double d[2] = {here[4] - here[0], here[5] - here[1]};
    const double w[2] = {here[6] - here[2], here[7] - here[3]};
    const double q = d[0] * d[0] + d[1] * d[1];
    const double length = std::sqrt(q);
    const double dot = w[0] * d[0] + w[1] * d[1];
    const double factor = stiffness_ * (1.0 - rest_length_ / length) + damping_ * dot / q;
    for (std::size_t a = 0; a < 2; ++a) {
      for (std::size_t b = 0; b < 2; ++b) {
        const double by_place =
            (a == b ? factor : 0.0) + d[a] * (stiffness_ * rest_length_ * d[b] / (q * length) +
                                              damping_ * (w[b] - 2.0 * dot * d[b] / q) / q);
        const double by_velocity = damping_ * d[a] * d[b] / q;
        for (std::size_t end = 0; end < 2; ++end) {  // the force on particle i, and its reaction
          const std::size_t row = 4 * (i + end) + 2 + a;
          const double share = (end == 0 ? 1.0 : -1.0) * inverse_masses_[i + end];
          add(row, 4 * (i + 1) + b, share * by_place);
          add(row, 4 * i + b, -share * by_place);
          add(row, 4 * (i + 1) + 2 + b, share * by_velocity);
          add(row, 4 * i + 2 + b, -share * by_velocity);
        }
      }
    }
  }
}

void interleave(std::size_t size, const double* arrays, double* interleaved) {
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t c = 0; c < 4; ++c) interleaved[4 * i + c] = arrays[c * size + i];
  }
}

void separate(std::size_t size, const double* interleaved, double* arrays) {
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t c = 0; c < 4; ++c) arrays[c * size + i] = interleaved[4 * i + c];
  }
}

}  // namespace spring_pendulum::benchmark

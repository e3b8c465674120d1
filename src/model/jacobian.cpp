#include "model/jacobian.hpp"

namespace spring_pendulum {

void computeSpringJacobian(const SpringLaw& law, const StateView& state, SpringJacobian& jacobian) {
  const auto x = state.col(0), y = state.col(1), vx = state.col(2), vy = state.col(3);
  auto stiffness = [&](int entry) { return jacobian.stiffness.col(entry).data(); };
  auto damping = [&](int entry) { return jacobian.damping.col(entry).data(); };
  double *kxx = stiffness(0), *kxy = stiffness(1), *kyx = stiffness(2), *kyy = stiffness(3);
  double *cxx = damping(0), *cxy = damping(1), *cyx = damping(2), *cyy = damping(3);
  for (Eigen::Index i = 0; i + 1 < state.rows(); ++i) {
    const double dx = x[i + 1] - x[i], dy = y[i + 1] - y[i];
    const double wx = vx[i + 1] - vx[i], wy = vy[i + 1] - vy[i];
    const double inverse_length = inverseSquareRoot(dx * dx + dy * dy);
    const double rx = dx * inverse_length, ry = dy * inverse_length;
    const double rate = law.damping * (wx * rx + wy * ry);
    const double preload = law.stiffness * law.rest_length;
    const double e = inverse_length > 0.0 ? law.stiffness + (rate - preload) * inverse_length : 0.0;
    const double bx = ((preload - 2.0 * rate) * rx + law.damping * wx) * inverse_length;
    const double by = ((preload - 2.0 * rate) * ry + law.damping * wy) * inverse_length;
    kxx[i] = e + rx * bx;
    kxy[i] = rx * by;
    kyx[i] = ry * bx;
    kyy[i] = e + ry * by;
    cxx[i] = law.damping * rx * rx;
    cxy[i] = cyx[i] = law.damping * rx * ry;
    cyy[i] = law.damping * ry * ry;
  }
}

}  // namespace spring_pendulum

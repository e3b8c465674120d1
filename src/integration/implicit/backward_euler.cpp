#include "integration/implicit/backward_euler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

constexpr int kMostIterations = 50;
/// Relative change below which the next iteration, whose error is of second order, would only round.
constexpr double kSettled = 1e-9;
/// Rounding error of a coordinate, relative to the largest.
constexpr double kRounding = 1e-13;
constexpr double kTiny = 1e-150;  ///< m/s; squares of such numbers are hardly normal

}  // namespace

BackwardEuler::BackwardEuler(const Chain& chain, bool track_dissipation)
    : SteppedIntegrator(chain, track_dissipation),
      chain_(chain),
      solver_(chain_),
      springs_(static_cast<std::size_t>(chain.size() - 1)),
      begin_(chain.size()),
      slope_(chain.size()),
      x_(static_cast<std::size_t>(chain.size())),
      y_(x_.size()) {}

void BackwardEuler::step(double time_step) {
  begin_.values() = current().values();
  held_.place(current().values(), 1);
  failed_ = failed_ || !solve(time_step);
  held_.place(current().values(), 0);
  addPowers(current(), time_step);
  trapezoidalRule(current(), begin_, time_step);
  if (failed_) {
    ++force_evaluations_;  // limits on work also end a run after a failure
    auto moving = current().values().bottomRows(current().size() - 1);
    moving.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

bool BackwardEuler::solve(double time_step) {
  auto velocities = current().values().rightCols<2>();
  auto positions = current().values().leftCols<2>();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    positions = begin_.values().leftCols<2>() + time_step * velocities;
    held_.place(current().values(), 0);  // their springs act from the true places
    linearise(time_step);
    solver_.factor(springs_, time_step);
    solver_.solve(x_.data(), y_.data());
    double change = 0.0, finite = 0.0;
    for (Eigen::Index i = 1; i < current().size(); ++i) {
      const double x = x_[static_cast<std::size_t>(i)], y = y_[static_cast<std::size_t>(i)];
      velocities(i, 0) += x;
      velocities(i, 1) += y;
      change = std::max({change, std::abs(x), std::abs(y)});
      finite += 0.0 * (x + y);
    }
    if (!std::isfinite(change + finite)) return false;
    const double rounding = kTiny + kRounding * positions.cwiseAbs().maxCoeff() / time_step;
    if (change > kSettled * velocities.cwiseAbs().maxCoeff() + rounding) continue;
    positions = begin_.values().leftCols<2>() + time_step * velocities;
    return true;
  }
  return false;
}

void BackwardEuler::linearise(double time_step) {
  evaluate(current(), slope_);
  const auto z = current().values(), from = begin_.values(), slope = slope_.values();
  for (Eigen::Index i = 0; i < z.rows(); ++i) {
    const double mass = massOf(chain_, i);
    const auto row = static_cast<std::size_t>(i);
    x_[row] = mass * (time_step * slope(i, 2) - (z(i, 2) - from(i, 2)));
    y_[row] = mass * (time_step * slope(i, 3) - (z(i, 3) - from(i, 3)));
    if (i + 1 == z.rows()) break;
    const PlaneVector<double> separation{z(i + 1, 0) - z(i, 0), z(i + 1, 1) - z(i, 1)};
    const PlaneVector<double> velocity{z(i + 1, 2) - z(i, 2), z(i + 1, 3) - z(i, 3)};
    springs_[row] = linearSpring(chain_.spring(), separation, velocity,
                                 springTension(chain_.spring(), separation, velocity));
  }
}

}  // namespace spring_pendulum

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

void requireAtLeastZero(const char* name, double value, const char* unit) {
  if (std::isfinite(value) && value >= 0.0) return;
  throw InputError(fmt::format("{} is {}: must be finite and at least 0 {}", name, value, unit));
}

}  // namespace

Chain::Chain(Eigen::VectorXd masses, const SpringLaw& spring, double gravity)
    : masses_(std::move(masses)), spring_(spring), gravity_(gravity) {
  if (masses_.size() < 1) throw InputError("a chain needs at least one particle, the fixed one");
  requireAtLeastZero("stiffness", spring.stiffness, "N/m");
  requireAtLeastZero("damping", spring.damping, "N·s/m");
  requireAtLeastZero("rest_length", spring.rest_length, "m");
  if (!std::isfinite(gravity)) {
    throw InputError(fmt::format("gravity is {}: must be a finite number of m/s²", gravity));
  }
  for (Eigen::Index i = 1; i < masses_.size(); ++i) {
    if (std::isfinite(masses_[i]) && masses_[i] > 0.0 && std::isfinite(1.0 / masses_[i])) continue;
    throw InputError(
        fmt::format("mass of particle {} is {}: a moving particle needs a finite mass above 0 kg",
                    i + 1, masses_[i]));
  }
  inverse_masses_ = masses_.cwiseInverse();
  inverse_masses_[0] = 0.0;
  equal_masses_ = size() < 3 || (masses_.tail(size() - 1).array() == masses_[1]).all();
}

}  // namespace spring_pendulum

#include "simulation/interruptible.hpp"

#include "simulation/integrator_settings.hpp"
#include "simulation/tolerance.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

using Clock = std::chrono::steady_clock;

/// Small enough that the number of parts of 1e9 frames is exact as a double.
constexpr std::int64_t kPartsOfAStep = std::int64_t{1} << 20U;
// Size of the first piece, whose computing time is still unknown: particles times steps for a fixed
// step, particles times simulated seconds for an error-controlled method.
constexpr double kFirstSteps = 1e6;
constexpr double kFirstTime = 1e4;
constexpr std::chrono::milliseconds kShort{50};
constexpr std::chrono::milliseconds kLong{200};

}  // namespace

InterruptibleIntegrator::InterruptibleIntegrator(std::unique_ptr<Integrator> integrator,
                                                 bool error_controlled, Eigen::Index particles,
                                                 std::function<bool()> is_interrupted)
    : integrator_(std::move(integrator)),
      parts_(error_controlled ? kPartsOfAStep : 1),
      particles_(static_cast<double>(particles)),
      is_interrupted_(std::move(is_interrupted)) {}

std::int64_t InterruptibleIntegrator::firstPiece(double part) const {
  if (parts_ == 1) return std::max<std::int64_t>(std::llround(kFirstSteps / particles_), 1);
  const double time = std::min(kFirstTime / particles_, 1.0);
  return static_cast<std::int64_t>(
      std::clamp(time / part, 1.0, static_cast<double>(kPartsOfAStep)));
}

void InterruptibleIntegrator::advance(State& state, double time_step, std::int64_t steps) {
  const double part = time_step / static_cast<double>(parts_);
  if (piece_ == 0) piece_ = firstPiece(part);
  for (std::int64_t left = steps * parts_; left > 0;) {
    if (is_interrupted_()) throw Interrupted();
    const std::int64_t piece = std::min(piece_, left);
    const Clock::time_point start = Clock::now();
    integrator_->advance(state, part, piece);
    left -= piece;
    const Clock::duration taken = Clock::now() - start;
    if (piece == piece_ && taken < kShort && left > 0) piece_ *= 2;
    if (taken > kLong) piece_ = std::max<std::int64_t>(piece / 2, 1);
  }
}

std::unique_ptr<Integrator> makeInterruptible(const Scenario& scenario, const Chain& chain,
                                              const State& start, bool track_dissipation,
                                              std::function<bool()> is_interrupted) {
  checkTolerance(scenario, chain, start);
  return std::make_unique<InterruptibleIntegrator>(
      makeIntegrator(scenario.method, chain, integratorOptions(scenario, track_dissipation)),
      !scenario.method.get().hasFixedStep(), chain.size(), std::move(is_interrupted));
}

}  // namespace spring_pendulum

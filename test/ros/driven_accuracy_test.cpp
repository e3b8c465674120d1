// A cable whose ends follow poses at 50 Hz: the node's way from inputs to accelerations, and the
// motion against a solution with 113 bits under the same accelerations.
#include "ros/inputs/driver.hpp"
#include "ros/inputs/robots.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <tuple>

#include "support/precise_motion.hpp"
#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

constexpr double kInputInterval = 0.02;   // s: 50 Hz
constexpr double kStateInterval = 0.025;  // s: inputs are up to 0.02 s old when they act

/// A hand that starts at rest at `from`, reaches out and moves about.
PlaneVector<double> handAt(double t, const PlaneVector<double>& from, double phase) {
  const double start = 1.0 - std::exp(-4.0 * t * t);
  const double x = 0.35 * std::sin(2.1 * t + phase) + 0.08 * std::sin(7.3 * t);
  const double y = 0.45 * std::cos(1.7 * t - phase) + 0.05 * std::cos(9.1 * t);
  return {from.x + start * x, from.y + start * y};
}

/// A holder whose poses have noise of 1 mm.
class Robot {
 public:
  Robot(std::ptrdiff_t particle, const State& start, double phase, unsigned seed)
      : particle_(particle),
        from_{start.x()[particle], start.y()[particle]},
        phase_(phase),
        random_(seed),
        follower_("pose", 1.0, [](const std::string&) {}) {}

  /// Sends the poses until the present time, and holds the particle.
  void follow(const Run& run, Driver& driver) {
    for (; next_ * kInputInterval <= run.nextTime() + 1e-9; ++next_) {
      const double stamp = next_ * kInputInterval;
      const PlaneVector<double> hand = handAt(stamp, from_, phase_);
      EXPECT_TRUE(follower_.take({hand.x + noise(1e-3), hand.y + noise(1e-3)}, stamp, stamp));
    }
    const PlaneVector<double> here{run.state().x()[particle_], run.state().y()[particle_]};
    const auto target = follower_.targetAt(run.nextTime(), here, run.nextTime() - run.time());
    driver.on(Hold{particle_, target.value()});
  }

  /// Distance of the particle from its holder, m.
  double lag(const Run& run) const {
    const PlaneVector<double> hand = handAt(run.time(), from_, phase_);
    return std::hypot(run.state().x()[particle_] - hand.x, run.state().y()[particle_] - hand.y);
  }

 private:
  double noise(double size) {
    return size * (static_cast<double>(random_()) / static_cast<double>(std::mt19937::max()) - 0.5);
  }

  std::ptrdiff_t particle_;
  PlaneVector<double> from_;
  double phase_;
  std::mt19937 random_;
  Follower follower_;
  int next_ = 0;
};

struct Outcome {
  double error = 0.0;     ///< of the position at the end, m
  double residual = 0.0;  ///< of the energy balance, relative
  double lag = 0.0;       ///< largest distance of an end from its holder, m
};

/// Lets two robots carry the ends of a cable for 3 s.
/// \param steps between two states, of a fixed-step method
Outcome carried(const std::string& method, double tolerance, std::int64_t steps = 1) {
  test::Scene scene = test::horizontalChain("cable", 7, 0.2);
  scene.start.x() *= 0.8;
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.tolerance = tolerance;
  scenario.frames = 1000;
  scenario.steps_per_frame = steps;
  scenario.time_step = kStateInterval / static_cast<double>(steps);
  scenario.frame_interval = kStateInterval;
  Run run(makeScene(scenario, {scene.chain.masses(), scene.start}), scenario, {true, 0.0, {}});
  run.advance();
  test::PreciseMotion precise(scene);
  Driver driver(run);
  Robot left(0, scene.start, 0.3, 1), right(6, scene.start, 2.0, 2);
  Outcome outcome;
  for (int k = 0; k < 120; ++k) {
    left.follow(run, driver);
    right.follow(run, driver);
    driver.apply(run, run.nextTime(), false);
    precise.drive(run.chain());
    const double before = run.time();
    run.advance();
    precise.advance(run.time() - before);
    outcome.lag = std::max({outcome.lag, left.lag(run), right.lag(run)});
  }
  EXPECT_GT(std::abs(run.energyEntry().supplied), 0.1);
  EXPECT_FALSE(isBad(run.verdict().kind)) << method << ": " << run.verdict().text;
  outcome.error = precise.errorOf(run.state());
  outcome.residual = std::abs(run.energyEntry().relative_residual.value());
  return outcome;
}

// The series ends at every input, so its steps are shorter than the tolerance asks for.
TEST(CarriedCable, KeepsTheToleranceOfAuto) {
  for (const double tolerance : {1e-4, 1e-6, 1e-9}) {
    const Outcome outcome = carried("Auto", tolerance);
    EXPECT_LE(outcome.error, 10.0 * tolerance) << tolerance;  // 2e-7 to 1e-4 tolerances
    EXPECT_GT(outcome.error, 0.0);
    EXPECT_LE(outcome.residual, 1e-6) << tolerance;  // 9e-12 and less
    EXPECT_LE(outcome.lag, 0.02) << tolerance;       // 0.0085 m
  }
}

TEST(CarriedCable, HasTheOrderOfTheMethods) {
  for (const auto& [method, order, steps] :
       {std::tuple{"Euler", 1, 160}, {"Runge-Kutta-2", 2, 10}, {"Runge-Kutta-4", 4, 5}}) {
    const Outcome coarse = carried(method, 1e-6, steps), fine = carried(method, 1e-6, 2 * steps);
    // 1.00, 1.96 and 3.97
    EXPECT_NEAR(std::log2(coarse.error / fine.error), order, 0.15)
        << method << ": " << coarse.error;
    EXPECT_GT(std::log2(coarse.residual / fine.residual), order - 0.75) << method;
  }
}

}  // namespace
}  // namespace spring_pendulum

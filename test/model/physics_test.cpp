// The forces and energies of a chain agree with each other and with the laws of mechanics.
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/model/energy.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace spring_pendulum {
namespace {

/// A bent chain with random masses, positions and velocities; no spring is shorter than 0.1 m.
struct RandomScene {
  static constexpr Eigen::Index kSize = 12;

  explicit RandomScene(unsigned seed) : state(kSize), masses(kSize) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    for (Eigen::Index i = 0; i < kSize; ++i) {
      masses[i] = 1.5 + unit(random);
      if (i == 0) continue;
      state.x()[i] = state.x()[i - 1] + 0.7 + 0.6 * unit(random);
      state.y()[i] = state.y()[i - 1] + unit(random);
      state.vx()[i] = 3.0 * unit(random);
      state.vy()[i] = 3.0 * unit(random);
    }
  }

  State state;
  Eigen::VectorXd masses;
  SpringLaw spring{37.0, 2.5, 0.8};
  double gravity = 9.81;
};

Eigen::MatrixXd accelerationsOf(const Chain& chain, const State& state) {
  State slope;
  computeSlope(chain, state, slope);
  return slope.velocities();
}

TEST(Force, IsMinusTheGradientOfThePotentialWithoutDamping) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    RandomScene scene(seed);
    scene.spring.damping = 0.0;
    const Chain chain(scene.masses, scene.spring, scene.gravity);
    const Eigen::MatrixXd accelerations = accelerationsOf(chain, scene.state);
    const double h = 1e-5;
    for (Eigen::Index i = 1; i < chain.size(); ++i)
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        double potential[2] = {};
        for (const int side : {0, 1}) {
          State moved = scene.state;
          moved.values()(i, axis) += side == 0 ? -h : h;
          const Energy energy = computeEnergy(chain, moved);
          potential[side] = energy.gravity + energy.spring;
        }
        const double gradient = (potential[1] - potential[0]) / (2.0 * h);
        // Measured: 8e-8 N at the most, of forces of up to 80 N.
        EXPECT_NEAR(chain.masses()[i] * accelerations(i, axis), -gradient, 1e-6);
      }
  }
}

TEST(Force, OfTheDashpotIsDampingTimesTheRateOfTheLength) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomScene scene(seed);
    const Chain chain(scene.masses, scene.spring, scene.gravity);
    SpringLaw undamped = scene.spring;
    undamped.damping = 0.0;
    const Chain elastic(scene.masses, undamped, scene.gravity);
    for (Eigen::Index i = 0; i + 1 < chain.size(); ++i) {
      const auto d = (scene.state.positions().row(i + 1) - scene.state.positions().row(i)).eval();
      const auto w = (scene.state.velocities().row(i + 1) - scene.state.velocities().row(i)).eval();
      const double h = 1e-6;
      const double rate = ((d + h * w).norm() - (d - h * w).norm()) / (2.0 * h);
      const PlaneVector<double> with = springForceOn(chain, scene.state, i);
      const PlaneVector<double> without = springForceOn(elastic, scene.state, i);
      // Measured: 5e-9 N at the most.
      EXPECT_NEAR(with.x - without.x, scene.spring.damping * rate * d.normalized().x(), 1e-7);
      EXPECT_NEAR(with.y - without.y, scene.spring.damping * rate * d.normalized().y(), 1e-7);
    }
  }
}

// Recorded bits, the same on every machine. std::hypot, which rounds differently in different C
// libraries, gives others for every seventh separation, and for these two.
TEST(SpringLength, HasTheRecordedBits) {
  State state(4);
  state.x() << 0.0, -0.89461131730248233, 0.0, -2.283880842795865;
  state.y() << 0.0, 2.4681482874670611, 0.0, -2.5852862882728433;
  EXPECT_EQ(springLength(state, 0), 0x1.50091d4fefc45p+1);
  EXPECT_EQ(springLength(state, 2), 0x1.b98cdb7582c47p+1);
  EXPECT_EQ(springLengths(state, 0, 3), 2.0 * springLength(state, 0) + springLength(state, 2));
  EXPECT_EQ(springLengths(state, 1, 1), 0.0);
}

TEST(Power, LostIsThatOfTheDashpots) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RandomScene scene(seed);
    const Chain chain(scene.masses, scene.spring, scene.gravity);
    const Eigen::MatrixXd accelerations = accelerationsOf(chain, scene.state);
    const double h = 1e-6;
    double energy[2] = {};
    for (const int side : {0, 1}) {
      State moved = scene.state;
      const double step = side == 0 ? -h : h;
      moved.positions().bottomRows(chain.size() - 1) +=
          step * scene.state.velocities().bottomRows(chain.size() - 1);
      moved.velocities() += step * accelerations;
      energy[side] = computeEnergy(chain, moved).total();
    }
    const double lost = dissipatedPower(chain, scene.state);
    EXPECT_GT(lost, 0.0);
    // Measured: 4e-7 W at the most, of up to 400 W.
    EXPECT_NEAR((energy[1] - energy[0]) / (2.0 * h), -lost, 1e-5);
  }
}

}  // namespace
}  // namespace spring_pendulum

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace spring_pendulum {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expectRefused(const Eigen::VectorXd& masses, const SpringLaw& spring, double gravity,
                   const char* part_of_message) {
  try {
    const Chain chain(masses, spring, gravity);
    FAIL() << "accepted; expected: " << part_of_message;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(part_of_message));
  }
}

TEST(Chain, RefusesWhatIsOutOfRange) {
  const Eigen::VectorXd masses = Eigen::VectorXd::Ones(3);
  expectRefused({}, {}, 9.81, "at least one particle");
  expectRefused(masses, {-1.0, 1.0, 1.0}, 9.81,
                "stiffness must be finite and at least 0 N/m, got -1");
  expectRefused(masses, {50.0, kInfinity, 1.0}, 9.81,
                "damping must be finite and at least 0 N·s/m, got inf");
  expectRefused(masses, {50.0, 1.0, -0.5}, 9.81,
                "rest_length must be finite and at least 0 m, got -0.5");
  expectRefused(masses, {}, kInfinity, "gravity must be a finite number in m/s², got inf");
  EXPECT_THROW(Chain(masses, Constants{{}, 9.81, -1.0}), InputError);
  EXPECT_THROW(Chain(masses, Constants{{}, 9.81, kInfinity}), InputError);
  for (const double mass : {0.0, -1.0, kInfinity, 5e-324})
    expectRefused(Eigen::Vector3d(1.0, 1.0, mass), {}, 9.81, "mass of particle 3");
  expectRefused(Eigen::Vector3d(kInfinity, 1.0, 1.0), {}, 9.81, "mass of particle 1");
}

TEST(Chain, NeverUsesTheMassOfTheFixedParticle) {
  const Chain chain(Eigen::Vector3d(0.0, 1.0, 1.0), {}, 9.81);
  EXPECT_EQ(chain.inverseMasses()[0], 0.0);
}

}  // namespace
}  // namespace spring_pendulum

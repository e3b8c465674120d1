#include <spring_pendulum/model/spring_law.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace spring_pendulum {
namespace {

TEST(InverseSquareRoot, IsRightToOneAndAHalfUnitsInTheLastPlaceOverAllMagnitudes) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> mantissa(1.0, 2.0);
  double worst = 0.0;
  for (int exponent = -1022; exponent <= 1023; ++exponent)
    for (int k = 0; k < 50; ++k) {
      const double square = std::ldexp(mantissa(random), exponent);
      const double found = inverseSquareRoot(square);
      const long double exact = 1.0L / std::sqrt(static_cast<long double>(square));
      const double unit = std::nextafter(found, HUGE_VAL) - found;
      worst = std::max(worst, static_cast<double>(std::abs(found - exact)) / unit);
    }
  EXPECT_LT(worst, 1.5);  // measured: 1.46
  EXPECT_GT(worst, 0.5);  // two roundings: not always the nearest double
}

TEST(InverseSquareRoot, IsDefinedWhereThereIsNoDirection) {
  for (const double square : {0.0, -0.0, HUGE_VAL}) EXPECT_EQ(inverseSquareRoot(square), 0.0);
  EXPECT_TRUE(std::isfinite(inverseSquareRoot(std::numeric_limits<double>::denorm_min())));
}

TEST(SpringForce, OfASpringWithoutLengthIsZeroAndNotANumberStaysOne) {
  const PlaneVector<double> nowhere{0.0, 0.0};
  const PlaneVector<double> force =
      springForce(SpringLaw{}, nowhere, PlaneVector<double>{1.0, 2.0});
  EXPECT_EQ(force.x, 0.0);
  EXPECT_EQ(force.y, 0.0);
  const PlaneVector<double> lost{std::nan(""), 1.0};
  EXPECT_TRUE(std::isnan(springForce(SpringLaw{}, lost, nowhere).x));
}

TEST(SpringForce, WithoutDampingHasTheBitsOfDampingZero) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> number(-2.0, 2.0);
  for (const SpringLaw& law :
       {SpringLaw{50.0, 0.0, 1.0}, SpringLaw{3.0, 0.0, 0.0}, SpringLaw{0.0, 0.0, 1.0}}) {
    for (int k = 0; k < 1000; ++k) {
      const PlaneVector<double> separation{number(random), number(random)};
      const PlaneVector<double> relative_velocity{number(random), number(random)};
      const PlaneVector<double> full = springForce(law, separation, relative_velocity);
      const PlaneVector<double> skipped =
          undampedSpringForce(law, separation, inverseLength(separation));
      EXPECT_EQ(std::memcmp(&full, &skipped, sizeof full), 0);
    }
  }
}

}  // namespace
}  // namespace spring_pendulum

#include "integration/error_control/step_size_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace spring_pendulum {
namespace {

TEST(Root, IsTheRoot) {
  for (int k = 1; k <= 32; ++k) {
    for (const double x : {1e-300, 3e-17, 1e-3, 0.5, 0.75, 1.0, 2.0, 1e9, 1e300})
      EXPECT_NEAR(root(x, k) / std::pow(x, 1.0 / k), 1.0, 2e-5) << x << " " << k;
    EXPECT_EQ(root(0.0, k), 0.0);
    EXPECT_EQ(root(1e-310, k), root(1e-300, k));
  }
}

TEST(StepSizeController, SettlesWhereTheErrorIsJustBelowTheAllowedOne) {
  for (const int k : {3, 5, 8}) {
    StepSizeController controller(k);
    double h = 1.0, error = 0.0;
    for (int n = 0; n < 60; ++n) {
      error = std::pow(h / 0.01, k);
      h = controller.next(h, error);
    }
    EXPECT_LT(error, 1.0);
    EXPECT_GT(error, 0.1);  // measured: 0.60 (k = 3), 0.43 (5), 0.26 (8)
  }
}

TEST(StepSizeController, DoesNotGrowRightAfterARejectionOrForWhatIsNoNumber) {
  StepSizeController controller(5);
  EXPECT_LT(controller.next(1.0, 2.0), 1.0);
  EXPECT_LE(controller.next(0.5, 1e-9), 0.5);
  EXPECT_GT(controller.next(0.5, 1e-9), 0.5);
  EXPECT_LT(controller.next(1.0, std::numeric_limits<double>::quiet_NaN()), 0.5);
  EXPECT_LT(controller.next(1.0, std::numeric_limits<double>::infinity()), 0.5);
}

}  // namespace
}  // namespace spring_pendulum

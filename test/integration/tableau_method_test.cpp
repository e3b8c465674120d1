#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace spring_pendulum {
namespace {

TEST(MethodOfTableau, FindsOrderAndLimitsOfTheBuiltInMethods) {
  int methods = 0;
  for (const Method& method : methodTable()) {
    if (method.tableau == nullptr || !method.hasFixedStep()) continue;
    const Method found = methodOfTableau("own", *method.tableau);
    EXPECT_EQ(found.order, method.order) << method.name;
    EXPECT_EQ(found.stages, method.stages) << method.name;
    // Measured: at most 1.2e-12.
    EXPECT_NEAR(found.real_stability_limit, method.real_stability_limit, 1e-10) << method.name;
    EXPECT_NEAR(found.imaginary_stability_limit, method.imaginary_stability_limit, 1e-10)
        << method.name;
    ++methods;
  }
  EXPECT_GE(methods, 3);
}

TEST(MethodOfTableau, FindsThirdOrder) {
  const ButcherTableau kutta{3, {{{}, {0.5}, {-1.0, 2.0}}}, {1.0 / 6, 2.0 / 3, 1.0 / 6}};
  const Method method = methodOfTableau("Kutta-3", kutta);
  EXPECT_EQ(method.order, 3);
  EXPECT_NEAR(method.real_stability_limit, 2.512745, 1e-6);
  EXPECT_NEAR(method.imaginary_stability_limit, std::sqrt(3.0), 1e-6);
}

TEST(MethodOfTableau, RefusesWhatIsNoMethod) {
  EXPECT_THROW(methodOfTableau("half", {1, {}, {0.5}}), InputError);
  EXPECT_THROW(methodOfTableau("empty", {}), InputError);
  EXPECT_THROW(methodOfTableau("implicit", {1, {{{1.0}}}, {1.0}}), InputError);
  EXPECT_THROW(methodOfTableau("nan", {1, {}, {std::nan("")}}), InputError);
}

}  // namespace
}  // namespace spring_pendulum

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

TEST(MethodTable, EveryNameFindsItsOwnRowAndMakesAnIntegrator) {
  const Chain chain(Eigen::VectorXd::Ones(3), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    EXPECT_EQ(findMethod(method.name).name, method.name);
    EXPECT_NE(makeIntegrator(method, chain), nullptr) << method.name;
  }
}

TEST(MethodTable, UnknownNameListsTheKnownOnes) {
  try {
    findMethod("Simpson");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 ("unknown method 'Simpson'; known methods: " + knownMethodNames()).c_str());
  }
}

}  // namespace
}  // namespace spring_pendulum

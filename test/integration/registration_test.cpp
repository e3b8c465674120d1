// Methods that a program registers.
#include "io/program/command_line.hpp"
#include "simulation/options/scenario_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "own_methods.hpp"
#include "support/reference.hpp"

namespace spring_pendulum {
namespace {

using test::referenceScene;

/// Registers the methods once.
const std::vector<const Method*>& ownMethods() {
  static const std::vector<const Method*> kMethods = [] {
    registerOwnMethods();
    return std::vector<const Method*>{&findMethod("Ralston"), &findMethod("Heun")};
  }();
  return kMethods;
}

/// Parses the arguments of a program into a scenario.
Switches parse(const std::vector<const char*>& arguments, Scenario& scenario) {
  std::vector<const char*> with_program{"Exercise3"};
  with_program.insert(with_program.end(), arguments.begin(), arguments.end());
  OptionSet options(scenarioOptions(scenario));
  return parseCommandLine(static_cast<int>(with_program.size()), with_program.data(),
                          {"Exercise3", "", ""}, options, scenario);
}

TEST(OwnMethods, AreMethodsOfTheCommandLine) {
  for (const Method* method : ownMethods()) {
    Scenario scenario;
    parse({method->name.c_str(), "--time-step", "0.002"}, scenario);
    EXPECT_EQ(&scenario.method.get(), method);
    EXPECT_NE(method->tableau, &kRalstonTableau);  // the table has a copy
    EXPECT_EQ(scenario.time_step, 0.002);
    EXPECT_THROW(parse({method->name.c_str(), "--tolerance", "1e-6"}, scenario), InputError);
    const std::string listed = parse({"--list-methods"}, scenario).answer;
    EXPECT_THAT(listed, testing::HasSubstr(method->name + " "));
    EXPECT_THAT(listed, testing::HasSubstr(method->use));
    EXPECT_THAT(parse({"--help"}, scenario).answer, testing::HasSubstr(method->name));
  }
}

// The coefficients decide, not the address: a copy of a fast tableau is fast.
TEST(OwnMethods, WithTheCoefficientsOfAFastTableauHaveItsBits) {
  Method copy{"Midpoint-Copy", 2, 2, StepControl::kFixed, 2.0};
  const ButcherTableau tableau = kMidpointTableau;
  copy.tableau = &tableau;
  registerMethod(copy);
  State states[2] = {referenceScene("horizontal_11").start, referenceScene("horizontal_11").start};
  const Chain chain = referenceScene("horizontal_11").chain;
  makeIntegrator("Runge-Kutta-2", chain)->advance(states[0], 0.01, 100);
  makeIntegrator("Midpoint-Copy", chain)->advance(states[1], 0.01, 100);
  EXPECT_EQ(states[0].values(), states[1].values());
}

struct BadMethod {
  const char* error;
  void (*spoil)(Method& method, ButcherTableau& tableau);
};

TEST(OwnMethods, AreRefusedIfTheyCannotWork) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<BadMethod> bad_methods{
      {"name", [](Method& m, ButcherTableau&) { m.name = ""; }},
      {"of this name exists", [](Method& m, ButcherTableau&) { m.name = "Euler"; }},
      {"order", [](Method& m, ButcherTableau&) { m.order = 0; }},
      {"stages", [](Method& m, ButcherTableau&) { m.stages = 0; }},
      {"stages", [](Method& m, ButcherTableau&) { m.stages = 3; }},
      {"limits", [](Method& m, ButcherTableau&) { m.real_stability_limit = kNan; }},
      {"limits", [](Method& m, ButcherTableau&) { m.imaginary_stability_limit = -1.0; }},
      {"tableau or a factory", [](Method& m, ButcherTableau&) { m.tableau = nullptr; }},
      {"fixed-step method",
       [](Method& m, ButcherTableau&) { m.control = StepControl::kErrorControlled; }},
      {"0 stages", [](Method&, ButcherTableau& t) { t.stages = 0; }},
      {"17 stages", [](Method&, ButcherTableau& t) { t.stages = 17; }},
      {"diagonal", [](Method&, ButcherTableau& t) { t.a[0][1] = 0.5; }},
      {"diagonal", [](Method&, ButcherTableau& t) { t.a[1][1] = 0.5; }},
      {"finite", [](Method&, ButcherTableau& t) { t.a[1][0] = kNan; }},
      {"finite", [](Method&, ButcherTableau& t) { t.b[1] = kNan; }},
  };
  for (const BadMethod& bad : bad_methods) {
    ButcherTableau tableau = kRalstonTableau;
    Method method{"Bad", 2, 2, StepControl::kFixed, 2.0};
    method.tableau = &tableau;
    bad.spoil(method, tableau);
    const std::size_t rows = methodTable().size();
    try {
      registerMethod(method);
      ADD_FAILURE() << "no error: " << bad.error;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(bad.error));
    }
    EXPECT_EQ(methodTable().size(), rows);
  }
}

// A user may pass a method that was never registered, or one whose factory makes nothing.
TEST(OwnMethods, MustHaveAFactory) {
  Method method{"Unregistered", 2, 2, StepControl::kFixed};
  const Chain chain = referenceScene("two_masses_45deg").chain;
  for (const ButcherTableau* tableau :
       {static_cast<const ButcherTableau*>(nullptr), &kRalstonTableau}) {
    method.tableau = tableau;
    try {
      makeIntegrator(method, chain);
      ADD_FAILURE() << "no error";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("method 'Unregistered' has no factory"));
    }
  }
  method.make = [](const Method&, const Chain&, const IntegratorOptions&) {
    return std::unique_ptr<Integrator>();
  };
  EXPECT_THROW(makeIntegrator(method, chain), InputError);
}

}  // namespace
}  // namespace spring_pendulum

// Every number of a scenario and of a method, at the limits of its type and of its range, through every
// public function that takes it: each call ends with an InputError or a result. Products of extreme
// options are tried with Exercise3 (process_extreme_options_test).
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/spring_pendulum.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "support/scenes.hpp"

namespace spring_pendulum {
namespace {

using Limits = std::numeric_limits<double>;
using Action = std::function<void()>;

const std::vector<double> kNumbers{
    0.0, -1.0, Limits::quiet_NaN(), Limits::infinity(), Limits::max(), Limits::denorm_min()};
const std::vector<std::int64_t> kCounts{0, -1, 1, std::numeric_limits<std::int64_t>::max(),
                                        std::numeric_limits<std::int64_t>::min()};
Scenario shortScenario(const std::string& method) {
  Scenario scenario;
  scenario.method = findMethod(method);
  scenario.frames = 3;
  scenario.steps_per_frame = 2;
  return scenario;
}

/// \returns the number of results: 1, or 0 for an InputError or too little memory
int gives(const Action& action) {
  try {
    action();
  } catch (const InputError&) {
    return 0;
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("not enough memory", 0), 0U) << error.what();
    return 0;
  }
  return 1;
}

/// Calls the public functions with a scenario and a chain of its springs. Returns how many have a result.
int tryFunctions(const Scenario& scenario) {
  const test::Scene scene = test::horizontalChain("", 3, 1.0);
  const Scene particles{scene.chain.masses(), scene.start};
  int asked = 0;
  const auto stop = [&asked] { return ++asked > 10; };
  int results = gives([&] {
    Run run(makeScene(scenario, particles), scenario, {true, 0.0, stop});
    while (run.advance()) continue;
    run.closingLine();
  });
  gives([&] {
    const Chain chain(particles.masses, scenario.constants);
    results += gives([&] { stabilityWarning(chain, scene.start, scenario); });
    results += gives([&] { remedyForDivergence(chain, scene.start, scenario, stop); });
  });
  return results;
}

/// The text of `--check` takes up to a few seconds.
int describe(const Scenario& scenario) {
  const test::Scene scene = test::horizontalChain("", 3, 1.0);
  return gives([&] {
    const Chain chain(scene.chain.masses(), scenario.constants);
    checkStability(chain, scene.start, scenario);
  });
}

/// Sets a numeric option. Returns false if the option is no number.
bool assign(const Option& option, double number, std::int64_t count) {
  const auto& variable = option.value.variable;
  if (option.is<double>()) *std::get<double*>(variable) = number;
  if (option.is<std::int64_t>()) *std::get<std::int64_t*>(variable) = count;
  return option.isNumber();
}

TEST(ExtremeValues, OfEveryFieldOfAScenario) {
  int fields = 0, results = 0;
  for (const char* method : {"Euler", "Runge-Kutta-4", "Semi-Implicit-Euler", "Auto"}) {
    Scenario scenario = shortScenario(method);
    const Scenario usual = scenario;
    for (const Option& option : scenarioOptions(scenario)) {
      if (!assign(option, 0.0, 0)) continue;
      ++fields;
      for (std::size_t i = 0; i < kNumbers.size(); ++i) {
        scenario = usual;
        assign(option, kNumbers[i], kCounts[i % kCounts.size()]);
        SCOPED_TRACE(std::string(method) + " " + std::string(option.key) + " " + option.text());
        results += tryFunctions(scenario) + describe(scenario);
      }
      scenario = usual;
    }
  }
  EXPECT_EQ(fields, 4 * 12);
  EXPECT_GT(results, 100);
}

TEST(ExtremeValues, OfEveryFieldOfAMethod) {
  const test::Scene scene = test::horizontalChain("", 3, 1.0);
  const std::vector<std::function<void(Method&, double)>> fields{
      [](Method& m, double value) { m.real_stability_limit = value; },
      [](Method& m, double value) { m.imaginary_stability_limit = value; },
      [](Method& m, double value) { m.bytes_per_particle = value; }};
  const std::vector<std::function<void(Method&, int)>> whole_fields{
      [](Method& m, int value) { m.order = value; },
      [](Method& m, int value) { m.stages = value; }};
  const auto use = [&](const Method& method) {
    gives([&] { linearStepLimit(method, scene.chain, 1.0); });
    Scenario scenario = shortScenario("Euler");
    scenario.method = method;
    tryFunctions(scenario);
  };
  for (const char* name : {"Euler", "Velocity-Verlet", "Auto"}) {
    for (const double value : kNumbers)
      for (const auto& set : fields) {
        Method method = findMethod(name);
        set(method, value);
        use(method);
      }
    for (const int value :
         {0, -1, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
      for (const auto& set : whole_fields) {
        Method method = findMethod(name);
        set(method, value);
        use(method);
      }
    }
    Method unmade = findMethod(name);
    unmade.make = {};
    EXPECT_FALSE(gives([&] { makeIntegrator(unmade, scene.chain); }) && unmade.tableau == nullptr);
  }
}

}  // namespace
}  // namespace spring_pendulum

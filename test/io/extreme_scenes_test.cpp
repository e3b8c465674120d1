// Random products of extreme scenes and values of options: what is refused is refused before the run.
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace spring_pendulum {
namespace {

using Values = std::vector<std::string>;

const Values kNumbers{"0", "5e-324", "1e-320", "1e-300", "1e-160", "1e-9",
                      "1", "1e10",   "1e160",  "1e300",  "1e308",  "1.7976931348623157e308"};
const Values kCounts{"0", "1", "2", "10", "4611686018427387904", "9223372036854775807"};
const Values kScenes{"0 0 1\n", "0 0 1\n1 0 1\n", "0 0 1\n1 0 1\n2 0 1e-300\n",
                     "0 0 1\n1e-150 0 1e300\n", "0 0 1\n1e150 0 1\n1e153 1 2\n"};

TEST(ExtremeScenes, AreRefusedBeforeTheRun) {
  std::mt19937 random(20261);
  const auto pick = [&](const Values& values) { return values[random() % values.size()]; };
  int refused = 0, accepted = 0;
  for (int i = 0; i < 1000; ++i) {
    const Method& method = methodTable()[random() % methodTable().size()];
    std::vector<std::pair<std::string, std::string>> options{{"method", method.name},
                                                             {"frames", "3"}};
    Scenario defaults;
    for (const Option& option : scenarioOptions(defaults)) {
      if (!option.isUsedBy(method) || random() % 4 != 0) continue;
      if (option.is<double>()) {
        options.emplace_back(option.key, pick(kNumbers));
      } else if (option.is<std::int64_t>()) {
        options.emplace_back(option.key, pick(kCounts));
      }
    }
    const std::string scene = pick(kScenes);
    SCOPED_TRACE(testing::PrintToString(options) + scene);
    std::optional<spring_pendulum::Run> run;
    int asked = 0;
    const auto stop = [&asked] { return ++asked > 3; };
    try {
      const Scenario scenario = makeScenario(options);
      run.emplace(makeScene(scenario, parseParticles(scene, "")), scenario,
                  RunOptions{true, 0.0, stop});
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    ++accepted;
    for (int frame = 0; frame < 5 && run->advance(); ++frame) continue;  // throws nothing
  }
  EXPECT_GT(refused, 200);
  EXPECT_GT(accepted, 200);
}

}  // namespace
}  // namespace spring_pendulum

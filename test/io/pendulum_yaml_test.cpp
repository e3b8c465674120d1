// config/pendulum.yaml can be read and has the defaults.
#include "io/files/text_file.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "support/parse_scenario.hpp"

namespace spring_pendulum {
namespace {

constexpr const char* kFile = PROJECT_DIR "/config/pendulum.yaml";

TEST(PendulumYaml, WorksWithEveryMethod) {
  const std::string text = readTextFile(kFile);
  for (const Method& method : methodTable()) {
    const std::string line = fmt::format("\nmethod: {}\n", method.name);
    const std::string with_method = std::regex_replace(text, std::regex("\nmethod: .*\n"), line);
    Scenario scenario = test::parseScenario(with_method, kFile), expected;
    expected.method = method;
    const std::vector<Option> options = scenarioOptions(scenario);
    const std::vector<Option> defaults = scenarioOptions(expected);
    for (std::size_t i = 0; i < options.size(); ++i) {
      EXPECT_EQ(options[i].text(), defaults[i].text()) << options[i].key;
    }
  }
}

}  // namespace
}  // namespace spring_pendulum

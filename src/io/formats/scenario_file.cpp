#include "io/files/text_file.hpp"
#include "io/formats/yaml_tree.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/io/scenario_file.hpp>

namespace spring_pendulum {

Scenario parseScenario(std::string_view text, std::string_view name) {
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  parseOptions(text, name, options);
  checkScenario(scenario);
  return scenario;
}

Scenario readScenarioFile(const std::string& path) {
  return parseScenario(readTextFile(path), path);
}

}  // namespace spring_pendulum

// A scenario from the text of a YAML file.
#pragma once

#include "io/formats/yaml_tree.hpp"
#include "simulation/options/scenario_options.hpp"

#include <string_view>

namespace spring_pendulum::test {

inline Scenario parseScenario(std::string_view text, std::string_view name) {
  Scenario scenario;
  OptionSet options(scenarioOptions(scenario));
  parseOptions(text, name, options);
  checkScenario(scenario);
  return scenario;
}

}  // namespace spring_pendulum::test

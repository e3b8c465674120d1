#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/option_list.hpp>

#include <fmt/format.h>

#include <variant>

namespace spring_pendulum {

std::vector<OptionDescription> describeOptions(const Scenario& defaults) {
  Scenario scenario = defaults;
  std::vector<OptionDescription> descriptions;
  for (const Option& option : scenarioOptions(scenario)) {
    descriptions.push_back({std::string(option.key), option.text(), std::string(option.unit),
                            option.range(), std::string(option.meaning),
                            std::string(option.users()), option.isText(), option.isFlag(),
                            std::holds_alternative<Count>(option.value)});
  }
  return descriptions;
}

Scenario makeScenario(const std::vector<std::pair<std::string, std::string>>& options,
                      Scenario scenario) {
  OptionSet set(scenarioOptions(scenario));
  for (const auto& [key, text] : options) set.set(set.find(key, "", "option"), text, key);
  const std::vector<std::string_view> unused = unusedKeys(scenario, set);
  if (!unused.empty()) {
    throw InputError(fmt::format(
        "{}: {}", unused.front(),
        whyUnused(scenario.method, [](std::string_view key) { return std::string(key); })));
  }
  checkScenario(scenario);
  return scenario;
}

}  // namespace spring_pendulum

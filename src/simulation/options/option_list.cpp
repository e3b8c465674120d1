#include "base/spelling.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/option_list.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace spring_pendulum {
namespace {

const Option& findOption(const OptionSet& options, const std::string& key) {
  const std::vector<Option>& rows = options.options();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [&](const Option& option) { return option.key == key; });
  if (row != rows.end()) return *row;
  std::vector<std::string> known;
  for (const Option& option : rows) known.emplace_back(option.key);
  throw InputError(unknownName("option", key, known));
}

}  // namespace

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
  for (const auto& [key, text] : options) set.set(findOption(set, key), text, key);
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

// Arbitrary bytes give parameters within their ranges or an error with its place.
#include "io/formats/yaml_tree.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <vector>

#include "fuzz_target.hpp"

namespace {

using namespace spring_pendulum;

/// Every option accepts its own text, and the texts give the same scenario.
void checkRoundTrip(Scenario& scenario) {
  Scenario again;
  const std::vector<Option> options = scenarioOptions(scenario), copies = scenarioOptions(again);
  for (std::size_t i = 0; i < options.size(); ++i) {
    copies[i].assign(options[i].text());
    require(copies[i].text() == options[i].text(), "the same text");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  Scenario scenario;
  try {
    OptionSet options(scenarioOptions(scenario));
    parseOptions(text, "run.yaml", options);
    checkScenario(scenario);
  } catch (const InputError& error) {
    // `frames` and `steps_per_frame` are checked together, without a line.
    const std::string message = error.what();
    require(message.rfind("run.yaml:", 0) == 0 || message.rfind("frames times", 0) == 0,
            "a message that tells where");
    return 0;
  }
  checkRoundTrip(scenario);
  return 0;
}

// Arbitrary lines `key text`, through the validation of command line, YAML and ROS parameters, give
// values within their ranges or an error with its place.
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/plan.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "fuzz_target.hpp"

namespace {

using namespace spring_pendulum;

/// Sets the options of all lines and continues after an error.
void setOptions(const std::string& text, OptionSet& options) {
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    const std::size_t space = line.find(' ');
    const std::string key = line.substr(0, space);
    try {
      const std::string value = space == std::string::npos ? "" : line.substr(space + 1);
      options.set(options.find(key, "~" + key), value, "~" + key);
    } catch (const InputError& error) {
      require(std::string(error.what()).rfind("~" + key + ":", 0) == 0,
              "a message that says where");
    }
  }
}

bool isAtLeastZero(double value) {
  return std::isfinite(value) && value >= 0.0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    std::string text(data, data + size);
    text.erase(std::remove(text.begin(), text.end(), '\0'),
               text.end());  // would truncate a message
    Scenario scenario;
    OptionSet options(scenarioOptions(scenario));
    setOptions(text, options);
    checkScenario(scenario);
    require(scenario.frames >= 1 && scenario.steps_per_frame >= 1, "counts from 1 on");
    require(isAtLeastZero(scenario.constants.spring.stiffness) &&
                isAtLeastZero(scenario.constants.spring.damping) &&
                isAtLeastZero(scenario.constants.spring.rest_length) &&
                std::isfinite(scenario.constants.gravity),
            "constants in range");
    require(scenario.timeOfFrame(scenario.frames - 1) >= 0.0, "times that do not wrap");
    for (const Option& option : options.options()) option.assign(option.text());
  } catch (const InputError& error) {
    require(*error.what() != '\0', "a message");
  }
  return 0;
}

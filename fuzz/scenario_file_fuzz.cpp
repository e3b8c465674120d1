// Any bytes are either parameters within their ranges or an error that tells where.
#include <spring_pendulum/io/scenario_file.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <cmath>
#include <string>
#include <variant>

#include "fuzz_target.hpp"

namespace {

using namespace spring_pendulum;

void checkRange(const Parameter& parameter, const Scenario& scenario) {
  std::visit(
      [&](auto member) {
        if constexpr (std::is_arithmetic_v<std::decay_t<decltype(scenario.*member)>> &&
                      !std::is_same_v<decltype(member), bool Scenario::*>) {
          const auto value = static_cast<double>(scenario.*member);
          require(std::isfinite(value) && value >= parameter.least, "a value within its range");
        }
      },
      parameter.member);
}

/// Setting every parameter from its own text changes nothing.
void checkRoundTrip(const Scenario& scenario) {
  ScenarioBuilder builder;
  for (const Parameter& parameter : parameterTable()) {
    checkRange(parameter, scenario);
    if (parameter.applies_to != AppliesTo::kAllMethods) continue;
    builder.set(parameter.key, formatValue(parameter, scenario), "");
  }
  const Scenario again = builder.build();
  for (const Parameter& parameter : parameterTable()) {
    if (parameter.applies_to != AppliesTo::kAllMethods) continue;
    require(formatValue(parameter, again) == formatValue(parameter, scenario), "the same text");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  Scenario scenario;
  try {
    ScenarioBuilder builder;
    parseScenario(text, "run.yaml", builder);
    scenario = builder.build();
  } catch (const InputError& error) {
    // `frames` and `steps_per_frame` are judged together, and not where one of them stands.
    const std::string message = error.what();
    require(message.rfind("run.yaml:", 0) == 0 || message.rfind("frames is", 0) == 0,
            "a message that tells where");
    return 0;
  }
  checkRoundTrip(scenario);
  return 0;
}

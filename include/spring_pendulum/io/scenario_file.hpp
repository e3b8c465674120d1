// A scenario from a YAML file: lines `key: value`, see config/pendulum.yaml.
#pragma once

#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <string_view>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Reads a scenario. Keys that are not in the file keep their defaults. Keys that the method does
/// not use, like `time_step` for an error-controlled method, are checked but have no effect.
/// \throws FileError if the file can't be read
/// \throws InputError with file and line for invalid YAML, an unknown key or a wrong value
Scenario readScenarioFile(const std::string& path);

/// Reads a scenario from text.
/// \param name name of the text in error messages
Scenario parseScenario(std::string_view text, std::string_view name);

}  // namespace spring_pendulum
#pragma GCC visibility pop

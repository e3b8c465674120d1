// Parameters of a run from a YAML file: lines `key: value` with the keys of the parameter table.
#pragma once

#include <spring_pendulum/simulation/parameters.hpp>

#include <string>
#include <string_view>

namespace spring_pendulum {

/// Hands every key of the file to `builder`; keys that are absent leave it as it is.
/// \throws FileError if the file can't be read
/// \throws InputError naming file and line for what is no YAML, an unknown key or a wrong value
void readScenarioFile(const std::string& path, ScenarioBuilder& builder);

/// The same for text in memory.
/// \param name what messages call the text
void parseScenario(std::string_view text, std::string_view name, ScenarioBuilder& builder);

}  // namespace spring_pendulum

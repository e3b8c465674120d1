// Options from a YAML file: lines `key: value`.
#pragma once

#include "simulation/options/option_set.hpp"

#include <yaml-cpp/eventhandler.h>

#include <string>
#include <string_view>

namespace spring_pendulum {

/// Passes a YAML document to a handler.
/// \param wanted what the text must be, for messages: "must be lines 'key: value'"
/// \throws InputError with name and line for invalid YAML, and what the handler throws
void parseYaml(std::string_view text, std::string_view name, YAML::EventHandler& handler,
               std::string_view wanted);

/// Sets the options in the file; the others keep their values.
/// \throws FileError if the file can't be read
/// \throws InputError with file and line for invalid YAML, an unknown key or a wrong value
void readOptionFile(const std::string& path, OptionSet& options);

/// Reads options from text.
/// \param name name of the text in error messages
void parseOptions(std::string_view text, std::string_view name, OptionSet& options);

}  // namespace spring_pendulum

// Options from a YAML file: lines `key: value`.
#pragma once

#include "simulation/options/option_set.hpp"

#include <string_view>

namespace spring_pendulum {

/// Sets the options in the text; the others keep their values.
/// \param name name of the text in error messages
/// \throws InputError with name and line for invalid YAML, an unknown key or a wrong value
void parseOptions(std::string_view text, std::string_view name, OptionSet& options);

}  // namespace spring_pendulum

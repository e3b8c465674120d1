// YAML files: a tree of a few nested levels with the lines for error messages, and options.
#pragma once

#include "simulation/options/scenario_options.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace spring_pendulum {

struct YamlTree {
  enum class Kind { kNothing, kScalar, kList, kMap };

  Kind kind = Kind::kNothing;
  std::string place;       ///< of its key, else of the value: "study.yaml:7"
  std::string text;        ///< of a scalar
  bool is_quoted = false;  ///< a scalar that is text even if it looks like a number
  std::vector<std::pair<std::string, YamlTree>> entries;  ///< of a map, or of a list without keys

  /// Returns the value of a key; null if there is none.
  const YamlTree* find(std::string_view key) const;
};

/// Reads one document.
/// \param name name of the text in error messages
/// \throws InputError with file and line for invalid YAML, deep nesting, aliases or a key given twice
YamlTree parseYamlTree(std::string_view text, std::string_view name);

/// Sets the options that a text has in lines `key: value`; the others keep their values.
/// \param name name of the text in error messages
/// \throws InputError with name and line for invalid YAML, an unknown key or a wrong value
void parseOptions(std::string_view text, std::string_view name, OptionSet& options);

}  // namespace spring_pendulum

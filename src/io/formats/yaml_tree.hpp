// A YAML file of a few nested levels as a tree, with the lines for error messages.
#pragma once

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

}  // namespace spring_pendulum

#include "io/formats/option_file.hpp"

#include "io/formats/yaml_tree.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

namespace spring_pendulum {

void parseOptions(std::string_view text, std::string_view name, OptionSet& options) {
  const YamlTree root = parseYamlTree(text, name);
  if (root.kind == YamlTree::Kind::kNothing) return;
  if (root.kind != YamlTree::Kind::kMap) {
    throw InputError(root.place + ": must be lines 'key: value'");
  }
  for (const auto& [key, value] : root.entries) {
    const Option& option = options.find(key, value.place);
    const std::string place = fmt::format("{}: {}", value.place, key);
    if (value.kind != YamlTree::Kind::kScalar || (value.is_quoted && !option.isText())) {
      throw InputError(fmt::format("{}: must be {}, a single value{}", place, option.range(),
                                   option.isText() ? "" : " without quotes"));
    }
    options.set(option, value.text, place);
  }
}

}  // namespace spring_pendulum

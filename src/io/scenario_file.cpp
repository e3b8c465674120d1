#include <spring_pendulum/io/scenario_file.hpp>
#include <spring_pendulum/io/text_file.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <variant>
#include <vector>

namespace spring_pendulum {
namespace {

std::string placeOf(std::string_view name, const YAML::Mark& mark) {
  return mark.is_null() ? std::string(name) : fmt::format("{}:{}", name, mark.line + 1);
}

bool isText(const Parameter& parameter) {
  return std::holds_alternative<std::string Scenario::*>(parameter.member);
}

/// yaml-cpp marks a plain scalar with the tag "?" and a quoted one, which is text, with "!".
bool hasRightType(const Parameter& parameter, const YAML::Node& value) {
  return value.IsScalar() && (value.Tag() == "?" || (isText(parameter) && value.Tag() == "!"));
}

void setFromEntry(const YAML::Node& key_node, const YAML::Node& value, std::string_view name,
                  std::set<std::string>& keys, ScenarioBuilder& builder) {
  const std::string where = placeOf(name, key_node.Mark());
  if (!key_node.IsScalar()) {
    throw InputError(where + ": a key that is no name, must be lines 'key: value'");
  }
  const std::string& key = key_node.Scalar();
  const Parameter& parameter = findParameter(key, where);
  if (!keys.insert(key).second) {
    throw InputError(fmt::format("{}: {} is given twice, must be given once", where, key));
  }
  if (!hasRightType(parameter, value)) {
    throw InputError(fmt::format("{}: {} must be {}, a single value{}", where, key, parameter.range,
                                 isText(parameter) ? "" : " without quotes"));
  }
  builder.set(key, value.Scalar(), where);
}

}  // namespace

void parseScenario(std::string_view text, std::string_view name, ScenarioBuilder& builder) {
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(std::string(text));
    if (documents.empty() || (documents.size() == 1 && documents[0].IsNull())) return;
    if (documents.size() > 1) {
      throw InputError(fmt::format("{}: {} documents, must be one", name, documents.size()));
    }
    if (!documents[0].IsMap()) {
      throw InputError(placeOf(name, documents[0].Mark()) + ": must be lines 'key: value'");
    }
    std::set<std::string> keys;
    for (const auto& entry : documents[0]) {
      setFromEntry(entry.first, entry.second, name, keys, builder);
    }
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}: no YAML ({}), must be lines 'key: value'",
                                 placeOf(name, error.mark), error.msg));
  }
}

void readScenarioFile(const std::string& path, ScenarioBuilder& builder) {
  parseScenario(readTextFile(path), path, builder);
}

}  // namespace spring_pendulum

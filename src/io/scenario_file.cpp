#include "io/text_file.hpp"
#include <spring_pendulum/io/scenario_file.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <set>
#include <sstream>
#include <variant>

namespace spring_pendulum {
namespace {

std::string placeOf(std::string_view name, const YAML::Mark& mark) {
  return mark.is_null() ? std::string(name) : fmt::format("{}:{}", name, mark.line + 1);
}

bool isText(const Parameter& parameter) {
  return std::holds_alternative<std::string Scenario::*>(parameter.member);
}

/// Takes the one document of a file as yaml-cpp comes across it and stops it at the first thing
/// that is no entry of a flat map. So nothing nested is ever built, however deep it is; and
/// YAML::LoadAll, which does not end for some broken files, is not needed.
class ScenarioHandler : public YAML::EventHandler {
 public:
  ScenarioHandler(std::string_view name, ScenarioBuilder& builder)
      : name_(name), builder_(builder) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_document_) refuse(mark, "a second document, must be one");
    has_document_ = true;
  }

  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    if (is_in_map_) refuseNested(mark);
    is_in_map_ = true;
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    if (!is_in_map_) refuseNested(mark);
    if (parameter_ == nullptr) {
      takeKey(mark, value);
    } else {
      takeValue(tag, value);
    }
  }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (is_in_map_) refuseNested(mark);  // else it is an empty file
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { refuseNested(mark); }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    refuseNested(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapEnd() override {}
  void OnDocumentEnd() override {}

 private:
  void takeKey(const YAML::Mark& mark, const std::string& key) {
    where_ = placeOf(name_, mark);
    parameter_ = &findParameter(key, where_);
    if (!keys_.insert(parameter_->key).second) {
      refuse(mark, fmt::format("{} is given twice, must be given once", key));
    }
  }

  /// yaml-cpp gives a plain scalar the tag "?" and a quoted one, which is text, the tag "!".
  void takeValue(const std::string& tag, const std::string& value) {
    if (tag != "?" && !(tag == "!" && isText(*parameter_))) refuseValue();
    builder_.set(parameter_->key, value, where_);
    parameter_ = nullptr;
  }

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", placeOf(name_, mark), what));
  }

  [[noreturn]] void refuseValue() const {
    throw InputError(fmt::format("{}: {} must be {}, a single value{}", where_, parameter_->key,
                                 parameter_->range, isText(*parameter_) ? "" : " without quotes"));
  }

  [[noreturn]] void refuseNested(const YAML::Mark& mark) const {
    if (parameter_ != nullptr) refuseValue();
    refuse(mark, "must be lines 'key: value'");
  }

  std::string_view name_;
  ScenarioBuilder& builder_;
  bool has_document_ = false;
  bool is_in_map_ = false;
  const Parameter* parameter_ = nullptr;  ///< whose value is to come
  std::string where_;                     ///< its key stands
  std::set<std::string_view> keys_;
};

}  // namespace

void parseScenario(std::string_view text, std::string_view name, ScenarioBuilder& builder) {
  std::istringstream stream{std::string(text)};
  try {
    YAML::Parser parser(stream);
    ScenarioHandler handler(name, builder);
    // The second call only finds out that there is no second document.
    if (parser.HandleNextDocument(handler)) parser.HandleNextDocument(handler);
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}: no YAML ({}), must be lines 'key: value'",
                                 placeOf(name, error.mark), error.msg));
  }
}

void readScenarioFile(const std::string& path, ScenarioBuilder& builder) {
  parseScenario(readTextFile(path), path, builder);
}

}  // namespace spring_pendulum

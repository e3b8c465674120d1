#include "io/formats/option_file.hpp"

#include "io/files/text_file.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>
#include <sstream>

namespace spring_pendulum {
namespace {

std::string placeOf(std::string_view name, const YAML::Mark& mark) {
  return mark.is_null() ? std::string(name) : fmt::format("{}:{}", name, mark.line + 1);
}

/// Handles the events of yaml-cpp's parser and throws at the first one that is not an entry of a
/// flat map, so nested input is never built. YAML::LoadAll does not return for some broken files.
class OptionHandler : public YAML::EventHandler {
 public:
  OptionHandler(std::string_view name, OptionSet& options) : name_(name), options_(options) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_document_) refuse(mark, "must be a single YAML document");
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
    if (option_ == nullptr) {
      takeKey(mark, value);
    } else {
      takeValue(tag, value);
    }
  }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    if (is_in_map_) refuseNested(mark);  // otherwise the file is empty
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
    const std::string place = placeOf(name_, mark);
    option_ = &options_.find(key, place);
    place_ = fmt::format("{}: {}", place, key);
    if (!keys_.insert(option_->key).second) {
      throw InputError(fmt::format("{}: is given twice; give it once", place_));
    }
  }

  /// yaml-cpp tags a plain scalar with "?" and a quoted one, which is text, with "!".
  void takeValue(const std::string& tag, const std::string& value) {
    if (tag != "?" && !(tag == "!" && option_->isText())) refuseValue();
    options_.set(*option_, value, place_);
    option_ = nullptr;
  }

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", placeOf(name_, mark), what));
  }

  [[noreturn]] void refuseValue() const {
    throw InputError(fmt::format("{}: must be {}, a single value{}", place_, option_->range(),
                                 option_->isText() ? "" : " without quotes"));
  }

  [[noreturn]] void refuseNested(const YAML::Mark& mark) const {
    if (option_ != nullptr) refuseValue();
    refuse(mark, "must be lines 'key: value'");
  }

  std::string_view name_;
  OptionSet& options_;
  bool has_document_ = false;
  bool is_in_map_ = false;
  const Option* option_ = nullptr;  ///< option whose value comes next
  std::string place_;               ///< file, line and key of `option_`
  std::set<std::string_view> keys_;
};

/// yaml-cpp takes a NUL for an escape character. YAML allows none of these characters.
void refuseControlCharacters(std::string_view text, std::string_view name) {
  const auto is_control = [](unsigned char c) {
    return c < 0x20 && c != '\t' && c != '\n' && c != '\r';
  };
  const char* const end = text.data() + text.size();
  const char* const found = std::find_if(text.data(), end, is_control);
  if (found == end) return;
  throw InputError(fmt::format("{}:{}: has a control character; must be UTF-8 text", name,
                               1 + std::count(text.data(), found, '\n')));
}

}  // namespace

void parseYaml(std::string_view text, std::string_view name, YAML::EventHandler& handler,
               std::string_view wanted) {
  refuseControlCharacters(text, name);
  // Without an explicit end of the document, yaml-cpp accepts a quotation mark that is not closed,
  // and the rest of the file would be the value.
  const bool ends_line = text.empty() || text.back() == '\n';
  std::istringstream stream{fmt::format("{}{}...\n", text, ends_line ? "" : "\n")};
  try {
    YAML::Parser parser(stream);
    // The second call only checks that there is no second document.
    if (parser.HandleNextDocument(handler)) parser.HandleNextDocument(handler);
  } catch (const YAML::Exception& error) {
    if (error.msg == YAML::ErrorMsg::DOC_IN_SCALAR) {
      throw InputError(fmt::format("{}: a quotation mark is not closed", name));
    }
    throw InputError(
        fmt::format("{}: invalid YAML ({}); {}", placeOf(name, error.mark), error.msg, wanted));
  }
}

void parseOptions(std::string_view text, std::string_view name, OptionSet& options) {
  OptionHandler handler(name, options);
  parseYaml(text, name, handler, "must be lines 'key: value'");
}

void readOptionFile(const std::string& path, OptionSet& options) {
  parseOptions(readTextFile(path), path, options);
}

}  // namespace spring_pendulum

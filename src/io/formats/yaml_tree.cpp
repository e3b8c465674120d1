#include "io/formats/yaml_tree.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <sstream>

namespace spring_pendulum {
namespace {

/// yaml-cpp recurses for nested input, so a deep file would overflow the stack.
constexpr std::size_t kMostLevels = 6;

std::string placeOf(std::string_view name, const YAML::Mark& mark) {
  return mark.is_null() ? std::string(name) : fmt::format("{}:{}", name, mark.line + 1);
}

/// Builds the tree from the events of yaml-cpp's parser. YAML::LoadAll hangs on some broken files.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string_view name, YamlTree& root) : name_(name), root_(root) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_document_) refuse(mark, "must be a single YAML document");
    has_document_ = true;
  }
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override {
    add(mark, YamlTree::Kind::kNothing);
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                const std::string& value) override {
    if (expectsKey()) {
      if (open_.back()->find(value) != nullptr) refuse(mark, value + ": is given twice");
      key_ = value;
      key_place_ = placeOf(name_, mark);
      return;
    }
    // yaml-cpp tags a plain scalar with "?" and a quoted one, which is text, with "!".
    if (tag != "?" && tag != "!") refuse(mark, key_.value_or("a value") + ": must not have a tag");
    YamlTree& scalar = add(mark, YamlTree::Kind::kScalar);
    scalar.text = value;
    scalar.is_quoted = tag == "!";
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    open(mark, YamlTree::Kind::kList);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    open(mark, YamlTree::Kind::kMap);
  }
  void OnMapEnd() override { open_.pop_back(); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    refuse(mark, "must not use aliases");
  }
  void OnDocumentEnd() override {}

 private:
  bool expectsKey() const {
    return !open_.empty() && open_.back()->kind == YamlTree::Kind::kMap && !key_;
  }

  YamlTree& add(const YAML::Mark& mark, YamlTree::Kind kind) {
    if (expectsKey()) refuse(mark, "a key must be a word");
    YamlTree* tree = &root_;
    if (!open_.empty()) {
      tree = &open_.back()->entries.emplace_back(key_.value_or(""), YamlTree{}).second;
    }
    tree->kind = kind;
    tree->place = key_ ? key_place_ : placeOf(name_, mark);
    key_.reset();
    return *tree;
  }

  void open(const YAML::Mark& mark, YamlTree::Kind kind) {
    if (open_.size() >= kMostLevels) refuse(mark, "is nested too deeply");
    open_.push_back(&add(mark, kind));
  }

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(fmt::format("{}: {}", placeOf(name_, mark), what));
  }

  std::string_view name_;
  YamlTree& root_;
  bool has_document_ = false;
  std::vector<YamlTree*> open_;  ///< an entry stays in place while its own entries are added
  std::optional<std::string> key_;
  std::string key_place_;
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

const YamlTree* YamlTree::find(std::string_view key) const {
  for (const auto& [name, value] : entries) {
    if (kind == Kind::kMap && name == key) return &value;
  }
  return nullptr;
}

YamlTree parseYamlTree(std::string_view text, std::string_view name) {
  refuseControlCharacters(text, name);
  // Without an explicit end of the document, yaml-cpp accepts a quotation mark that is not closed,
  // and the rest of the file would be the value.
  const bool ends_line = text.empty() || text.back() == '\n';
  std::istringstream stream{fmt::format("{}{}...\n", text, ends_line ? "" : "\n")};
  YamlTree root;
  TreeBuilder builder(name, root);
  try {
    YAML::Parser parser(stream);
    // The second call only checks that there is no second document.
    if (parser.HandleNextDocument(builder)) parser.HandleNextDocument(builder);
  } catch (const YAML::Exception& error) {
    if (error.msg == YAML::ErrorMsg::DOC_IN_SCALAR) {
      throw InputError(fmt::format("{}: a quotation mark is not closed", name));
    }
    throw InputError(fmt::format("{}: invalid YAML ({})", placeOf(name, error.mark), error.msg));
  }
  return root;
}

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

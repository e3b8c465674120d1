#include "sweep/study/yaml_tree.hpp"

#include "io/formats/option_file.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>

#include <optional>

namespace spring_pendulum::sweep {
namespace {

/// yaml-cpp recurses for nested input, so a deep file would overflow the stack.
constexpr std::size_t kMostLevels = 6;

/// Builds the tree from the events of yaml-cpp's parser.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string name, YamlTree& root) : name_(std::move(name)), root_(root) {}

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
      return;
    }
    if (tag != "?" && tag != "!") refuse(mark, "must not have a tag");
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
    key_.reset();
    tree->kind = kind;
    tree->place = fmt::format("{}:{}", name_, mark.line + 1);
    return *tree;
  }

  void open(const YAML::Mark& mark, YamlTree::Kind kind) {
    if (open_.size() >= kMostLevels) refuse(mark, "is nested too deeply");
    open_.push_back(&add(mark, kind));
  }

  [[noreturn]] void refuse(const YAML::Mark& mark, const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, mark.line + 1, what));
  }

  std::string name_;
  YamlTree& root_;
  bool has_document_ = false;
  std::vector<YamlTree*> open_;  ///< an entry stays in place while its own entries are added
  std::optional<std::string> key_;
};

}  // namespace

const YamlTree* YamlTree::find(std::string_view key) const {
  for (const auto& [name, value] : entries) {
    if (kind == Kind::kMap && name == key) return &value;
  }
  return nullptr;
}

YamlTree parseYamlTree(std::string_view text, const std::string& name) {
  YamlTree root;
  TreeBuilder builder(name, root);
  parseYaml(text, name, builder, "must be a study");
  return root;
}

}  // namespace spring_pendulum::sweep

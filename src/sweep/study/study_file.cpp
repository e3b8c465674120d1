#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/files/text_file.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>

#include "sweep/study/checksum.hpp"
#include "sweep/study/columns.hpp"
#include "sweep/study/random_numbers.hpp"
#include "sweep/study/study.hpp"
#include "sweep/study/yaml_tree.hpp"

namespace spring_pendulum::sweep {
namespace {

using Kind = YamlTree::Kind;

/// Significant digits of the values of `linear` and `log`.
constexpr int kDigits = 12;

[[noreturn]] void refuse(const YamlTree& tree, std::string_view key, const std::string& what) {
  throw InputError(fmt::format("{}: {}: {}", tree.place, key, what));
}

const std::string& textOf(const YamlTree& tree, std::string_view key) {
  if (tree.kind != Kind::kScalar) refuse(tree, key, "must be a single value");
  return tree.text;
}

/// Sets an option, or only checks a value for it.
void assign(const Option& option, const YamlTree& tree) {
  if (tree.kind != Kind::kScalar || (tree.is_quoted && !option.isText())) {
    refuse(tree, option.key,
           fmt::format("must be {}, a single value{}", option.range(),
                       option.isText() ? "" : " without quotes"));
  }
  try {
    option.assign(tree.text);
  } catch (const InputError& error) {
    refuse(tree, option.key, error.what());
  }
}

double numberOf(const YamlTree& tree, std::string_view key) {
  double value = 0.0;
  assign({key, Number{&value, Range::any()}, "", ""}, tree);
  return value;
}

/// Refuses keys other than those of `known`.
void checkKeys(const YamlTree& map, std::string_view what, const std::vector<std::string>& known) {
  if (map.kind != Kind::kMap) {
    throw InputError(fmt::format("{}: {}: must be lines 'key: value'", map.place, what));
  }
  for (const auto& [key, value] : map.entries) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(fmt::format("{}: {}", value.place, unknownName("key", key, known)));
  }
}

/// The values `{linear: [first, last, number]}` or `{log: ...}`. Time steps end at the duration of `base`.
std::vector<std::string> scale(const YamlTree& tree, const Option& option, bool is_log,
                               const Settings& base) {
  if (tree.kind != Kind::kList || tree.entries.size() != 3) {
    refuse(tree, option.key, "must be [first, last, number of values]");
  }
  const double first = numberOf(tree.entries[0].second, option.key);
  const double last = numberOf(tree.entries[1].second, option.key);
  std::int64_t count = 0;
  assign({option.key, Count{&count, Range::between(2, 1e6)}, "", ""}, tree.entries[2].second);
  if (is_log && !(first > 0.0 && last > 0.0)) {
    refuse(tree, option.key, "the first and the last value of log must be above 0");
  }
  std::vector<std::string> values;
  for (std::int64_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double value =
        is_log ? portableExp((1.0 - share) * portableLog(first) + share * portableLog(last))
               : (1.0 - share) * first + share * last;
    values.push_back(roundedText(value, kDigits));
    if (option.key != "time_step" || base.duration == 0.0) continue;
    values.back() = numberText(fittedTimeStep(base, parseNumber(values.back()).value_or(value)));
  }
  return values;
}

/// `all`, `fixed-step` or `error-controlled` instead of a list of methods.
std::vector<std::string> methodsOf(const YamlTree& tree) {
  const std::string& word = tree.text;
  std::vector<std::string> names;
  for (const Method& method : methodTable()) {
    if (word == "all" || word == (method.hasFixedStep() ? "fixed-step" : "error-controlled")) {
      names.push_back(method.name);
    }
  }
  if (names.empty()) {
    refuse(tree, "method",
           "must be a list, all, fixed-step or error-controlled, got " + inQuotes(word));
  }
  return names;
}

std::vector<std::string> listOf(const YamlTree& tree, std::string_view key) {
  if (tree.kind != Kind::kList || tree.entries.empty()) {
    refuse(tree, key, "must be a list with at least one value");
  }
  std::vector<std::string> values;
  for (const auto& entry : tree.entries) values.push_back(textOf(entry.second, key));
  return values;
}

std::vector<std::string> axisValues(const YamlTree& tree, const Option& option,
                                    const Settings& base) {
  if (tree.kind == Kind::kScalar && option.key == "method") return methodsOf(tree);
  if (tree.kind == Kind::kList) return listOf(tree, option.key);
  checkKeys(tree, option.key, {"list", "linear", "log", "with"});
  const YamlTree* const list = tree.find("list");
  const YamlTree* const linear = tree.find("linear");
  const YamlTree* const log = tree.find("log");
  const YamlTree* const forms[] = {list, linear, log};
  if (std::count(std::begin(forms), std::end(forms), nullptr) != 2) {
    refuse(tree, option.key, "must be {list: ...}, {linear: ...} or {log: ...}");
  }
  if (list != nullptr) return listOf(*list, option.key);
  return scale(linear != nullptr ? *linear : *log, option, log != nullptr, base);
}

Distribution distributionOf(const YamlTree& tree, const std::string& key) {
  const std::vector<std::string> names{"uniform", "log_uniform", "normal", "log_normal"};
  checkKeys(tree, key, names);
  if (tree.entries.size() != 1) refuse(tree, key, "must be one distribution");
  const auto& [name, values] = tree.entries.front();
  if (values.kind != Kind::kList || values.entries.size() != 2) {
    refuse(values, name, "must be a list of two numbers");
  }
  const auto index = std::find(names.begin(), names.end(), name) - names.begin();
  const Distribution distribution{static_cast<Distribution::Kind>(index + 1),
                                  numberOf(values.entries[0].second, name),
                                  numberOf(values.entries[1].second, name)};
  const bool is_log = name != "uniform" && name != "normal";
  const bool is_range = name == "uniform" || name == "log_uniform";
  if (is_log && distribution.first <= 0.0) refuse(values, name, "the first number must be above 0");
  if (!is_range && distribution.second < 0.0) {
    refuse(values, name, "the deviation must be at least 0");
  }
  if (is_range && distribution.second < distribution.first) {
    refuse(values, name, "the second number must be at least the first one");
  }
  return distribution;
}

class StudyReader {
 public:
  explicit StudyReader(const std::string& path)
      : text_(readTextFile(path)), folder_(std::filesystem::path(path).parent_path()) {
    study_.name = std::filesystem::path(path).stem().string();
    study_.hash = hashOf(text_, kHashStart);
    tree_ = parseYamlTree(text_, path);
  }

  Study read() {
    checkKeys(tree_, "study", {"base", "axes", "random", "columns", "plot"});
    readBase();
    readAxes();
    readRandom();
    readColumns();
    readPlot();
    const bool has_duration = study_.base.duration > 0.0 || given_.count("duration") > 0;
    if (has_duration && given_.count("frames") + given_.count("steps_per_frame") > 0)
      throw InputError(tree_.place + ": duration sets frames and steps_per_frame; leave them out");
    if (has_duration) given_.erase("frame_interval");  // for fixed steps, too
    refuseUnused();
    return std::move(study_);
  }

 private:
  void readBase() {
    OptionSet options(caseOptions(study_.base));
    if (const YamlTree* base = tree_.find("base")) {
      checkKeys(*base, "base", keysOf(options));
      for (const auto& [key, value] : base->entries) assign(take(options, key, value), value);
    }
    const YamlTree* axes = tree_.find("axes");
    if (axes != nullptr && axes->find("particles") != nullptr) return;
    study_.base.scenario.particles = load(study_.base.scenario.particles, tree_);
  }

  void readAxes() {
    const YamlTree* axes = tree_.find("axes");
    if (axes == nullptr) return;
    Settings settings = study_.base;
    OptionSet options(caseOptions(settings));
    checkKeys(*axes, "axes", keysOf(options));
    double cases = 1.0;
    for (const auto& [key, value] : axes->entries) {
      const Option& option = take(options, key, value);
      Axis axis{key, key + (option.unit.empty() ? "" : fmt::format(" [{}]", option.unit)), {}};
      if (const YamlTree* base = tree_.find("base");
          base != nullptr && base->find(key) != nullptr) {
        refuse(value, key, "stands in base, too");
      }
      for (const std::string& text : axisValues(value, option, study_.base)) {
        YamlTree scalar{Kind::kScalar, value.place, text, option.isText(), {}};
        assign(option, scalar);
        axis.values.push_back(key == "particles" ? load(text, value) : option.text());
      }
      axis.is_joined = isJoined(value, axis);
      if (!axis.is_joined) cases *= static_cast<double>(axis.values.size());
      study_.axes.push_back(std::move(axis));
    }
    if (cases > kMostCases) refuse(*axes, "axes", "there are more than 1e9 cases");
  }

  /// Whether `{with: KEY}` joins an axis to the one before.
  bool isJoined(const YamlTree& tree, const Axis& axis) const {
    const YamlTree* const with = tree.find("with");
    if (with == nullptr) return false;
    if (study_.axes.empty() || textOf(*with, "with") != study_.axes.back().key) {
      refuse(*with, "with", "must be the key of the axis before");
    }
    const std::size_t count = study_.axes.back().values.size();
    if (axis.values.size() == count) return true;
    refuse(tree, axis.key,
           fmt::format("must have as many values as {}, {}, got {}", study_.axes.back().key, count,
                       axis.values.size()));
  }

  /// Refuses an option that no method of the study uses.
  void refuseUnused() {
    std::vector<const Method*> methods{&study_.base.scenario.method.get()};
    for (const Axis& axis : study_.axes) {
      if (axis.key != "method") continue;
      methods.clear();
      for (const std::string& name : axis.values) methods.push_back(&findMethod(name));
    }
    const auto is_fixed = [](const Method* method) { return method->hasFixedStep(); };
    const bool all_fixed = std::all_of(methods.begin(), methods.end(), is_fixed);
    if (!all_fixed && std::any_of(methods.begin(), methods.end(), is_fixed)) return;
    for (const Option& option : caseOptions(study_.base)) {
      const auto given = given_.find(std::string(option.key));
      if (given == given_.end()) continue;
      if (option.applies_to != (all_fixed ? AppliesTo::kErrorControlled : AppliesTo::kFixedStep))
        continue;
      throw InputError(fmt::format(
          "{}: {}: {}", given->second, option.key,
          whyUnused(*methods.front(), [](std::string_view key) { return std::string(key); })));
    }
  }

  void readRandom() {
    const YamlTree* random = tree_.find("random");
    if (random == nullptr) return;
    checkKeys(*random, "random", {"seed", "samples", "mass_factor", "displacement", "velocity"});
    std::int64_t seed = 0;
    for (const auto& [key, value] : random->entries) {
      if (key == "seed") assign({key, Count{&seed, Range::atLeast(0)}, "", ""}, value);
      if (key == "samples")
        assign({key, Count{&study_.samples, Range::between(1, 1e9)}, "", ""}, value);
      if (key == "mass_factor") study_.mass_factor = distributionOf(value, key);
      if (key == "displacement") study_.displacement = distributionOf(value, key);
      if (key == "velocity") study_.velocity = distributionOf(value, key);
    }
    study_.seed = static_cast<std::uint64_t>(seed);
    if (study_.samples == 0) refuse(*random, "random", "samples is missing");
    const std::int64_t cases_per_sample = study_.cases() / study_.samples;
    if (static_cast<double>(study_.samples) * static_cast<double>(cases_per_sample) > kMostCases) {
      refuse(*random, "random", "there are more than 1e9 cases");
    }
    if (study_.mass_factor.kind == Distribution::Kind::kNormal ||
        (study_.mass_factor.kind == Distribution::Kind::kUniform &&
         study_.mass_factor.first <= 0.0)) {
      refuse(*random, "mass_factor",
             "must have positive values only: use log_normal, log_uniform "
             "or uniform above 0");
    }
  }

  void readColumns() {
    const YamlTree* columns = tree_.find("columns");
    if (columns == nullptr) {
      study_.columns = {"verdict", "position_error", "energy_error"};
      return;
    }
    study_.columns = listOf(*columns, "columns");
    std::set<std::string> seen;
    for (const std::string& name : study_.columns) {
      findColumn(name, columns->place);
      if (!seen.insert(name).second) refuse(*columns, "columns", name + " is given twice");
    }
  }

  void readPlot() {
    const YamlTree* plot = tree_.find("plot");
    if (plot == nullptr) return;
    checkKeys(*plot, "plot",
              {"type", "x", "y", "color", "lines", "panels", "limit", "title", "log"});
    PlotOptions& p = study_.plot;
    const std::pair<const char*, std::string*> titles[] = {
        {"x", &p.x},         {"y", &p.y},           {"color", &p.color},
        {"lines", &p.lines}, {"panels", &p.panels}, {"limit", &p.limit}};
    for (const auto& [key, title] : titles) {
      const YamlTree* value = plot->find(key);
      if (value != nullptr) *title = tableTitle(*value, key);
    }
    const std::vector<std::string> types{"map", "lines", "histogram"};
    for (const auto& [key, value] : plot->entries) {
      if (key == "title") p.title = textOf(value, key);
      if (key == "type") {
        const auto type = std::find(types.begin(), types.end(), textOf(value, key));
        if (type == types.end()) refuse(value, key, "must be map, lines or histogram");
        p.type = static_cast<PlotOptions::Type>(type - types.begin() + 1);
      }
      if (key == "log") {
        const std::string& axes = textOf(value, key);
        if (axes != "x" && axes != "y" && axes != "xy") refuse(value, key, "must be x, y or xy");
        p.log_x = axes.find('x') != std::string::npos;
        p.log_y = axes.find('y') != std::string::npos;
      }
    }
    const bool is_histogram = p.type == PlotOptions::Type::kHistogram;
    if (p.type == PlotOptions::Type::kNone || p.x.empty() || (p.y.empty() && !is_histogram) ||
        (p.color.empty() && p.type == PlotOptions::Type::kMap)) {
      refuse(*plot, "plot", "needs type and x; map needs y and color, lines needs y");
    }
    if (p.type == PlotOptions::Type::kMap) checkPlaces(*plot);
  }

  /// Refuses several cases at one place of a map.
  void checkPlaces(const YamlTree& plot) const {
    const PlotOptions& p = study_.plot;
    std::set<std::string> hidden;
    if (study_.samples > 1) hidden.insert("sample");
    bool is_shown = false;
    for (auto axis = study_.axes.rbegin(); axis != study_.axes.rend(); ++axis) {
      is_shown = is_shown || axis->key == p.x || axis->key == p.y || axis->key == p.panels;
      if (axis->is_joined) continue;
      if (!is_shown && axis->values.size() > 1) hidden.insert(axis->key);
      is_shown = false;
    }
    if (!hidden.empty()) refuse(plot, "plot", *hidden.begin() + " varies, too; use it for panels");
  }

  /// Returns the title of an axis or a column.
  std::string tableTitle(const YamlTree& tree, const std::string& key) const {
    const std::string& name = textOf(tree, key);
    std::vector<std::string> known = study_.columns;
    for (const Axis& axis : study_.axes) known.push_back(axis.key);
    if (study_.samples > 0) known.emplace_back("sample");
    if (std::find(known.begin(), known.end(), name) != known.end()) return name;
    refuse(tree, key, unknownName("axis or column", name, known));
  }

  static std::vector<std::string> keysOf(const OptionSet& options) {
    std::vector<std::string> keys;
    for (const Option& option : options.options()) keys.emplace_back(option.key);
    return keys;
  }

  const Option& take(const OptionSet& options, const std::string& key, const YamlTree& value) {
    given_[key] = value.place;
    return options.find(key, value.place);
  }

  /// Reads a particle file, whose path is relative to the study. \returns the path
  std::string load(const std::string& file, const YamlTree& tree) {
    std::string path = (folder_ / file).lexically_normal().string();
    if (study_.particles.count(path) > 0) return path;
    try {
      study_.hash = hashOf(readTextFile(path), study_.hash);
      study_.particles.emplace(path, readParticleFile(path));
    } catch (const FileError& error) {
      throw FileError(fmt::format("{}: particles: {}", tree.place, error.what()));
    }
    return path;
  }

  std::string text_;
  std::filesystem::path folder_;
  YamlTree tree_;
  Study study_;
  std::map<std::string, std::string> given_;  ///< key and place
};

}  // namespace

Study readStudy(const std::string& path) {
  return StudyReader(path).read();
}

}  // namespace spring_pendulum::sweep

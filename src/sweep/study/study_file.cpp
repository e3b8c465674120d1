#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/files/posix.hpp"
#include "io/formats/yaml_tree.hpp"
#include "simulation/options/scenario_options.hpp"
#include "sweep/study/random_numbers.hpp"
#include "sweep/study/study.hpp"
#include "sweep/table.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace spring_pendulum::sweep {
namespace {

using Kind = YamlTree::Kind;
using Entries = decltype(YamlTree::entries);

/// Significant digits of the values of `linear` and `log`.
constexpr int kDigits = 12;

[[noreturn]] void refuse(const YamlTree& tree, std::string_view key, const std::string& what) {
  throw InputError(fmt::format("{}: {}: {}", tree.place, key, what));
}

const std::string& textOf(const YamlTree& tree, std::string_view key) {
  if (tree.kind != Kind::kScalar) refuse(tree, key, "must be a single value");
  return tree.text;
}

void setOption(const YamlTree& tree, const Option& option, OptionSet& options) {
  const bool is_text = option.isText();
  if (tree.kind != Kind::kScalar || (tree.is_quoted && !is_text))
    refuse(tree, option.key,
           fmt::format("must be {}, a single value{}", option.range(),
                       is_text ? "" : " without quotes"));
  options.set(option, tree.text, fmt::format("{}: {}", tree.place, option.key));
}

void requireMap(const YamlTree& tree, std::string_view key) {
  if (tree.kind != Kind::kMap) refuse(tree, key, "must be lines 'key: value'");
}

/// Refuses keys other than those of `known`.
void checkKeys(const YamlTree& map, std::string_view what, const std::vector<std::string>& known) {
  requireMap(map, what);
  for (const auto& [key, value] : map.entries) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    throw InputError(fmt::format("{}: {}", value.place, unknownName("key", key, known)));
  }
}

const Entries& listOf(const YamlTree& tree, std::string_view key) {
  if (tree.kind == Kind::kList && !tree.entries.empty()) return tree.entries;
  refuse(tree, key, "must be a list with at least one value");
}

/// \param wanted for the message
std::vector<double> numbersOf(const YamlTree& tree, std::string_view key, std::size_t count,
                              const std::string& wanted) {
  if (tree.kind != Kind::kList || tree.entries.size() != count) refuse(tree, key, wanted);
  std::vector<double> numbers;
  for (const auto& entry : tree.entries) {
    double& number = numbers.emplace_back();
    OptionSet options({{key, Number{&number, Range::any()}, "", ""}});
    setOption(entry.second, options.options().front(), options);
  }
  return numbers;
}

/// The values `{linear: [first, last, number]}` or `{log: ...}`. Time steps end at the duration of `base`.
Entries scale(const YamlTree& tree, const Option& option, bool is_log, const Settings& base) {
  const std::vector<double> numbers =
      numbersOf(tree, option.key, 3, "must be [first, last, number of values]");
  const double first = numbers[0], last = numbers[1], count = numbers[2];
  if (count < 2.0 || count > 1e6 || count != std::floor(count))
    refuse(tree, option.key, "the number of values must be a whole number from 2 to 1e6");
  if (is_log && !(first > 0.0 && last > 0.0))
    refuse(tree, option.key, "the first and the last value of log must be above 0");
  Entries values;
  for (double i = 0.0; i < count; ++i) {
    const double share = i / (count - 1.0);
    const double value =
        is_log ? portableExp((1.0 - share) * portableLog(first) + share * portableLog(last))
               : (1.0 - share) * first + share * last;
    std::string text = roundedText(value, kDigits);
    if (option.key == "time_step" && base.duration > 0.0)
      text = numberText(fittedTimeStep(base, parseNumber(text).value_or(value)));
    values.push_back({"", {Kind::kScalar, tree.place, text, false, {}}});
  }
  return values;
}

/// `all`, `fixed-step` or `error-controlled` instead of a list of methods.
Entries methodsOf(const YamlTree& tree) {
  Entries names;
  for (const Method& method : methodTable()) {
    const char* const group = method.hasFixedStep() ? "fixed-step" : "error-controlled";
    if (tree.text != "all" && tree.text != group) continue;
    names.push_back({"", {Kind::kScalar, tree.place, method.name, false, {}}});
  }
  if (!names.empty()) return names;
  refuse(tree, "method", "must be a list, all, fixed-step or error-controlled");
}

Entries valuesOf(const YamlTree& tree, const Option& option, const Settings& base) {
  if (tree.kind == Kind::kScalar && option.key == "method") return methodsOf(tree);
  if (tree.kind == Kind::kList) return listOf(tree, option.key);
  checkKeys(tree, option.key, {"list", "linear", "log", "with"});
  const auto is_form = [](const auto& entry) { return entry.first != "with"; };
  if (std::count_if(tree.entries.begin(), tree.entries.end(), is_form) != 1)
    refuse(tree, option.key, "must be {list: ...}, {linear: ...} or {log: ...}");
  const auto& [form, values] = *std::find_if(tree.entries.begin(), tree.entries.end(), is_form);
  if (form == "list") return listOf(values, option.key);
  return scale(values, option, form == "log", base);
}

Distribution distributionOf(const YamlTree& tree, std::string_view key) {
  const std::vector<std::string> names{"uniform", "log_uniform", "normal", "log_normal"};
  checkKeys(tree, key, names);
  if (tree.entries.size() != 1) refuse(tree, key, "must be one distribution");
  const auto& [name, list] = tree.entries.front();
  const std::vector<double> numbers = numbersOf(list, name, 2, "must be a list of two numbers");
  const bool is_log = name != "uniform" && name != "normal";
  const bool is_range = name == "uniform" || name == "log_uniform";
  if (is_log && numbers[0] <= 0.0) refuse(list, name, "the first number must be above 0");
  if (numbers[1] < (is_range ? numbers[0] : 0.0))
    refuse(list, name,
           is_range ? "the second number must be at least the first one"
                    : "the deviation must be at least 0");
  return {numbers[0], numbers[1], true, is_log, is_range};
}

class StudyReader {
 public:
  explicit StudyReader(const std::string& path)
      : folder_(std::filesystem::path(path).parent_path()) {
    const std::string text = readTextFile(path);
    study_.name = std::filesystem::path(path).stem().string();
    study_.hash = hashOf(text + '\0');
    tree_ = parseYamlTree(text, path);
  }

  Study read() {
    checkKeys(tree_, "study", {"base", "axes", "random", "columns", "plot"});
    readBase();
    readAxes();
    readRandom();
    readColumns();
    readPlot();
    if (static_cast<double>(study_.cases()) > kMostCases)
      refuse(tree_, "study", "there are more than 1e9 cases");
    if (options_.isGiven("duration") &&
        (options_.isGiven("frames") || options_.isGiven("steps_per_frame")))
      throw InputError(tree_.place + ": duration sets frames and steps_per_frame; leave them out");
    refuseUnused();
    return std::move(study_);
  }

 private:
  void readBase() {
    if (const YamlTree* const base = tree_.find("base")) {
      requireMap(*base, "base");
      for (const auto& [key, value] : base->entries)
        setOption(value, options_.find(key, value.place, "key"), options_);
    }
    const YamlTree* const axes = tree_.find("axes");
    if (axes == nullptr || axes->find("particles") == nullptr) load();
    study_.base = settings_;
  }

  void readAxes() {
    const YamlTree* const axes = tree_.find("axes");
    if (axes == nullptr) return;
    requireMap(*axes, "axes");
    for (const auto& [key, value] : axes->entries) {
      if (options_.isGiven(key)) refuse(value, key, "stands in base, too");
      const Option& option = options_.find(key, value.place, "key");
      Axis axis{key, std::string(option.unit), {}};
      for (const auto& [unnamed, one] : valuesOf(value, option, study_.base)) {
        setOption(one, option, options_);
        if (key == "particles") load();
        axis.values.push_back(option.text());
      }
      axis.is_joined = isJoined(value, axis);
      study_.axes.push_back(std::move(axis));
    }
  }

  /// Whether `{with: KEY}` joins an axis to the one before.
  bool isJoined(const YamlTree& tree, const Axis& axis) const {
    const YamlTree* const with = tree.find("with");
    if (with == nullptr) return false;
    if (study_.axes.empty() || textOf(*with, "with") != study_.axes.back().key)
      refuse(*with, "with", "must be the key of the axis before");
    const std::size_t count = study_.axes.back().values.size();
    if (axis.values.size() == count) return true;
    refuse(tree, axis.key,
           fmt::format("must have as many values as {}, {}, got {}", study_.axes.back().key, count,
                       axis.values.size()));
  }

  /// Refuses an option that no method of the study uses.
  void refuseUnused() {
    Scenario scenario = study_.base.scenario;
    for (const Axis& axis : study_.axes) {
      if (axis.key != "method") continue;
      scenario.method = findMethod(axis.values.front());
      for (const std::string& name : axis.values) {
        if (findMethod(name).hasFixedStep() != scenario.method.get().hasFixedStep()) return;
      }
    }
    for (const std::string_view key : unusedKeys(scenario, options_)) {
      // With a duration, the interval is for fixed steps, too.
      if (key == "frame_interval" && options_.isGiven("duration")) continue;
      throw InputError(fmt::format(
          "{}: {}", options_.placeOf(key),
          whyUnused(scenario.method, [](std::string_view name) { return std::string(name); })));
    }
  }

  void readRandom() {
    const YamlTree* const random = tree_.find("random");
    if (random == nullptr) return;
    checkKeys(*random, "random", {"seed", "samples", "mass_factor", "displacement", "velocity"});
    OptionSet counts({{"seed", Count{&study_.seed, Range::atLeast(0)}, "", ""},
                      {"samples", Count{&study_.samples, Range::between(1, 1e9)}, "", ""}});
    for (const auto& [key, value] : random->entries) {
      if (key == "seed" || key == "samples") setOption(value, counts.find(key, ""), counts);
      if (key == "mass_factor") study_.mass_factor = distributionOf(value, key);
      if (key == "displacement") study_.displacement = distributionOf(value, key);
      if (key == "velocity") study_.velocity = distributionOf(value, key);
    }
    if (study_.samples == 0) refuse(*random, "random", "samples is missing");
    const Distribution& factor = study_.mass_factor;
    if (!factor.is_log && factor.is_given && (!factor.is_range || factor.first <= 0.0))
      refuse(*random, "mass_factor",
             "must have positive values only: use log_normal, log_uniform or uniform above 0");
  }

  void readColumns() {
    static const YamlTree kDefault =
        parseYamlTree("[verdict, position_error, energy_error]", "columns");
    const YamlTree* const given = tree_.find("columns");
    for (const auto& [unnamed, name] : listOf(given != nullptr ? *given : kDefault, "columns")) {
      const Column* const column = &findColumn(textOf(name, "columns"), name.place);
      auto& known = study_.columns;
      if (std::find(known.begin(), known.end(), column) != known.end())
        refuse(name, "columns", name.text + " is given twice");
      known.push_back(column);
    }
  }

  /// The script that draws the table checks the values.
  void readPlot() {
    const YamlTree* const plot = tree_.find("plot");
    if (plot == nullptr) return;
    checkKeys(*plot, "plot",
              {"type", "x", "y", "color", "lines", "panels", "limit", "title", "log"});
    for (const auto& [key, value] : plot->entries)
      study_.plot.push_back(fmt::format("--{}={}", key, textOf(value, key)));
  }

  /// Reads the particle file of the settings, whose path is relative to the study.
  void load() {
    std::string& path = settings_.scenario.particles;
    const std::filesystem::path full = folder_ / path, normal = full.lexically_normal();
    std::error_code ignored;  // after a symbolic link, ".." leads elsewhere
    const bool same = std::filesystem::equivalent(full, normal, ignored) ||
                      !(exists(full, ignored) || exists(normal, ignored));
    path = (same ? normal : full).string();
    if (study_.particles.count(path) > 0) return;
    try {
      study_.hash = hashOf(readTextFile(path) + '\0', study_.hash);
      study_.particles.emplace(path, readParticleFile(path));
    } catch (const FileError& error) {
      const std::string given = options_.placeOf("particles");
      throw FileError((given.empty() ? tree_.place + ": particles" : given) + ": " + error.what());
    }
  }

  std::filesystem::path folder_;
  YamlTree tree_;
  Study study_;
  Settings settings_;
  OptionSet options_{caseOptions(settings_)};  ///< of base and axes
};

}  // namespace

Study readStudy(const std::string& path) {
  return StudyReader(path).read();
}

}  // namespace spring_pendulum::sweep

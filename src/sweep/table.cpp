#include "sweep/table.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/outcome.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace spring_pendulum::sweep {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double largestStretch(const Run& run) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i + 1 < run.chain().size(); ++i)
    largest = std::max(largest, springLength(run.state(), i) - run.chain().spring().rest_length);
  return largest;
}

double divergenceTime(const Run& run) {
  return run.verdict().kind == VerdictKind::kDiverged ? run.verdict().time : kNan;
}

double linearStep(const Run& run) {
  const double duration = run.plan().timeOfFrame(run.plan().frames - 1);
  return duration > 0.0 ? linearStepLimit(run.plan().method, run.chain(), duration) : kNan;
}

/// A text as a field of CSV.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

const std::vector<Column>& allColumns() {
  static const std::vector<Column> kColumns{
      {"verdict", "", "verdict on the run, as Exercise3 reports it", nullptr},
      {"position_error", "m", "largest position error at the frames, against the reference run",
       [](const Run& run) { return run.positionError().largest; }},
      {"error_bound", "m", "largest sum of position error and uncertainty of the reference run",
       [](const Run& run) { return run.positionError().bound; }},
      {"measured_until", "s", "time until which the position error is known",
       [](const Run& run) { return run.positionError().measured_until; }, false, true},
      {"energy_error", "", "largest residual of the energy balance, in energy scales",
       [](const Run& run) { return run.largestEnergyError(); }},
      {"largest_stretch", "m", "largest elongation of a spring at the frames, at least 0",
       largestStretch, true},
      {"tip_x", "m", "position of the last particle at the end",
       [](const Run& run) { return run.state().x()[run.chain().size() - 1]; }},
      {"tip_y", "m", "position of the last particle at the end",
       [](const Run& run) { return run.state().y()[run.chain().size() - 1]; }},
      {"diverged_at", "s", "time of the divergence", divergenceTime, false, true},
      {"seconds", "s", "nominal computing time of the method, counted and not measured",
       [](const Run& run) {
         return parseNumber(roundedText(run.integrator().work(), 6)).value_or(kNan);
       },
       false, true},
      {"force_evaluations", "", "evaluations of the forces on the whole chain",
       [](const Run& run) { return static_cast<double>(run.integrator().forceEvaluations()); },
       false, true},
      {"linear_step", "s", "stability limit of the linearised chain, with a margin", linearStep,
       false, true},
  };
  return kColumns;
}

const Column& findColumn(std::string_view name, std::string_view place) {
  std::vector<std::string> known;
  for (const Column& column : allColumns()) {
    if (column.name == name) return column;
    known.emplace_back(column.name);
  }
  throw InputError(fmt::format("{}: {}", place, unknownName("column", name, known)));
}

std::string tableHeader(const Study& study) {
  std::string header = "case";
  const auto add = [&](std::string_view name, std::string_view unit) {
    header += fmt::format(unit.empty() ? ",{}" : ",{} [{}]", name, unit);
  };
  for (const Axis& axis : study.axes) add(axis.key, axis.unit);
  if (study.samples > 0) add("sample", "");
  for (const Column* column : study.columns) add(column->name, column->unit);
  return header + '\n';
}

std::string rowStart(const Study& study, std::int64_t index) {
  std::string row = std::to_string(index);
  const Place place = study.placeOf(index);
  for (const std::string& value : place.values) row += ',' + field(value);
  if (study.samples > 0) row += ',' + std::to_string(place.sample);
  return row;
}

std::optional<std::string> runCase(const Study& study, const Case& a_case,
                                   const std::function<bool()>& stop) {
  Plan plan = a_case.settings.scenario;
  plan.threads = 1;
  Run run(a_case.scene(), plan, {false, 0.0, stop, false});
  std::vector<double> largest(study.columns.size(), kNan);
  while (run.advance()) {
    for (std::size_t i = 0; i < largest.size(); ++i) {
      const Column& column = *study.columns[i];
      if (column.at_frames) largest[i] = std::fmax(largest[i], column.value(run));
    }
  }
  if (run.wasStopped()) return std::nullopt;
  std::string text;
  const VerdictKind verdict = run.verdict().kind;
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const Column& column = *study.columns[i];
    if (column.value == nullptr) {
      text += fmt::format(",{}", toString(verdict));
    } else if (verdict == VerdictKind::kDiverged && !column.if_diverged) {
      text += ",nan";
    } else {
      text += ',' + numberText(column.at_frames ? largest[i] : column.value(run));
    }
  }
  return text;
}

}  // namespace spring_pendulum::sweep

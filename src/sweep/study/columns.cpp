#include "sweep/study/columns.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace spring_pendulum::sweep {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double duration(const Run& run) {
  return frameSteps(run.scenario()).timeOfFrame(run.scenario().frames - 1);
}

double largestStableStep(const Run& run) {
  const Scenario& scenario = run.scenario();
  if (!(duration(run) > 0.0)) return kNan;
  return largestStableStep(run.chain(), run.start(), scenario).step;
}

double divergenceTime(const Run& run) {
  return run.verdict().kind == VerdictKind::kDiverged ? run.verdict().time : kNan;
}

}  // namespace

const std::vector<Column>& allColumns() {
  static const std::vector<Column> kColumns{
      {"verdict", "", "verdict on the run, as Exercise3 reports it",
       [](const Outcome& o) { return std::string(toString(o.run.verdict().kind)); }},
      {"position_error", "m", "largest position error at the frames, against the reference run",
       [](const Outcome& o) { return numberText(o.run.positionError().largest); }},
      {"error_bound", "m", "largest sum of position error and uncertainty of the reference run",
       [](const Outcome& o) { return numberText(o.run.positionError().bound); }},
      {"measured_until", "s", "time until which the position error is known",
       [](const Outcome& o) { return numberText(o.run.positionError().measured_until); }},
      {"energy_error", "1", "largest residual of the energy balance, in energy scales",
       [](const Outcome& o) {
         return numberText(o.run.energyEntry().relative_residual ? o.watched.energy_error : kNan);
       }},
      {"largest_stretch", "m", "largest elongation of a spring at the frames",
       [](const Outcome& o) { return numberText(o.watched.largest_stretch); }},
      {"tip_x", "m", "position of the last particle at the end",
       [](const Outcome& o) { return numberText(o.run.state().x()[o.run.chain().size() - 1]); }},
      {"tip_y", "m", "position of the last particle at the end",
       [](const Outcome& o) { return numberText(o.run.state().y()[o.run.chain().size() - 1]); }},
      {"diverged_at", "s", "time of the divergence",
       [](const Outcome& o) { return numberText(divergenceTime(o.run)); }},
      {"seconds", "s", "nominal computing time of the method, counted and not measured",
       [](const Outcome& o) { return roundedText(o.integrator.work(), 6); }},
      {"force_evaluations", "1", "evaluations of the forces on the whole chain",
       [](const Outcome& o) { return fmt::format("{}", o.integrator.forceEvaluations()); }},
      {"largest_stable_step", "s", "largest stable step size of a fixed-step method, by trial runs",
       [](const Outcome& o) { return numberText(largestStableStep(o.run)); }},
      {"linear_step", "s", "stability limit of the linearised chain, with a margin",
       [](const Outcome& o) {
         const double seconds = duration(o.run);
         const Method& method = o.run.scenario().method;
         return numberText(seconds > 0.0 ? linearStepLimit(method, o.run.chain(), seconds) : kNan);
       }},
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

WantedColumns::WantedColumns(const Study& study) {
  for (const std::string& name : study.columns) {
    columns_.push_back(&findColumn(name, ""));
    watches_stretch_ = watches_stretch_ || name == "largest_stretch";
    watches_energy_ = watches_energy_ || name == "energy_error";
  }
}

std::string Column::title() const {
  return unit.empty() || unit == "1" ? std::string(name) : fmt::format("{} [{}]", name, unit);
}

}  // namespace spring_pendulum::sweep

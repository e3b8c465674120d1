#include "sweep/running/case_runner.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/model/dynamics.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace spring_pendulum::sweep {
namespace {

/// Larger reference runs, in numbers of all frames, are not kept.
constexpr double kMostNumbers = 1e7;
/// Tolerances in m above this do not affect the reference run; see ReferenceOptions::run_tolerance.
constexpr double kLooseTolerance = 1e-7;
/// Digits that hide the rounding errors in the product of a step size and the steps per frame.
constexpr int kIntervalDigits = 14;

/// Time between frames, s. Step sizes that divide it have the same one.
double frameInterval(const Scenario& scenario) {
  const double interval = frameSteps(scenario).timeOfFrame(1);
  return parseNumber(roundedText(interval, kIntervalDigits)).value_or(interval);
}

double runTolerance(const Scenario& scenario) {
  return scenario.method.get().hasFixedStep() ? kLooseTolerance
                                              : std::min(scenario.tolerance, kLooseTolerance);
}

void watchStretch(const Run& run, double& largest) {
  for (Eigen::Index i = 0; i + 1 < run.chain().size(); ++i) {
    largest = std::max(largest, springLength(run.state(), i) - run.scenario().rest_length);
  }
}

/// A text as a field of CSV.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

}  // namespace

std::string sceneOf(const Study& study, const Case& a_case) {
  const Scenario& s = a_case.settings.scenario;
  const double numbers =
      4.0 * static_cast<double>(a_case.particles.masses.size()) * static_cast<double>(s.frames);
  if (s.reference == ReferenceUse::kNever || numbers > kMostNumbers) return {};
  std::string scene = s.particles;
  if (s.start == Start::kAtRest) scene += " at rest";
  if (study.samples > 0) scene += fmt::format(" {}", a_case.sample);
  for (const double value : {a_case.settings.mass_factor, s.stiffness, s.damping, s.rest_length,
                             s.gravity, s.air_drag, frameInterval(s), runTolerance(s)}) {
    scene += ' ' + numberText(value);
  }
  return scene;
}

std::shared_ptr<SharedReference> References::take(std::int32_t scene, const Case& a_case) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = std::find_if(scenes_.begin(), scenes_.end(),
                                  [scene](const Scene& s) { return s.number == scene; });
  if (found != scenes_.end()) {
    scenes_.splice(scenes_.begin(), scenes_, found);
    return found->reference;
  }
  const Scenario& s = a_case.settings.scenario;
  const Chain chain = s.chainOf(a_case.particles.masses);
  scenes_.push_front(
      {scene, std::make_shared<SharedReference>(chain, startOf(s, chain, a_case.particles),
                                                frameInterval(s), runTolerance(s))});
  if (scenes_.size() > most_) scenes_.pop_back();
  return scenes_.front().reference;
}

std::string tableHeader(const Study& study) {
  std::string header = "case";
  for (const Axis& axis : study.axes) header += ',' + axis.title;
  if (study.samples > 0) header += ",sample";
  for (const std::string& name : study.columns) header += ',' + findColumn(name, "").title();
  return header + '\n';
}

std::string rowStart(const Study& study, std::int64_t index) {
  std::string row = std::to_string(index);
  const Place place = study.placeOf(index);
  for (std::size_t i = 0; i < study.axes.size(); ++i) {
    row += ',' + field(study.axes[i].values[place.values[i]]);
  }
  if (study.samples > 0) row += ',' + std::to_string(place.sample);
  return row;
}

std::optional<std::string> runCase(const WantedColumns& columns, const Case& a_case,
                                   std::shared_ptr<SharedReference> reference,
                                   const std::function<bool()>& stop) try {
  Scenario scenario = a_case.settings.scenario;
  scenario.threads = 1;
  Run run(scenario, a_case.particles, {false, 0.0, stop, std::move(reference), false});
  const std::unique_ptr<Integrator> integrator = run.makeIntegrator();
  Watched watched;
  while (run.advance(*integrator)) {
    if (columns.watchesStretch()) watchStretch(run, watched.largest_stretch);
    if (columns.watchesEnergy()) {
      watched.energy_error = std::max(watched.energy_error,
                                      std::abs(run.energyEntry().relative_residual.value_or(0.0)));
    }
  }
  if (run.wasStopped()) return std::nullopt;
  std::string text;
  for (const Column* column : columns.all()) {
    text += ',';
    text += column->text({run, *integrator, watched});
  }
  return text;
} catch (const std::exception& error) {
  throw std::runtime_error(fmt::format("case {}: {}", a_case.index, error.what()));
}

}  // namespace spring_pendulum::sweep

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
                                   const std::function<bool()>& stop) try {
  Scenario scenario = a_case.settings.scenario;
  scenario.threads = 1;
  Run run(scenario, a_case.particles, {false, 0.0, stop, false});
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

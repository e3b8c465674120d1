// Tests of stability limits and advice.
// Two reports, as CSV in DIR:
// - stability_map.csv, stability_limit.csv: the verdict on a chain of eleven particles on a grid of
//   masses and time steps, for each method with a fixed step, and the linear limit of the step;
// - stability_advice.csv: steps advised on random scenes, and how runs with 0.9, 0.95, 1.05 and 1.1
//   times the step end.
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "options.hpp"
#include "support/random_scenes.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum::benchmark {
namespace {

using test::Scene;
using test::verdictOfRun;

constexpr double kDuration = 10.0;  // s, duration of a run
constexpr double kMostSteps = 1e6;  // longer runs are skipped
constexpr unsigned kScenes = 120;   // number of random scenes

/// Number of cells along each side of the map.
int cells(const Options& options) {
  return options.smoke ? 4 : 48;
}

double onScale(double least, double most, int cell, int cells) {
  return least * std::pow(most / least, static_cast<double>(cell) / (cells - 1));
}

std::vector<const Method*> fixedStepMethods() {
  std::vector<const Method*> methods;
  for (const Method& method : methodTable()) {
    if (method.hasFixedStep()) methods.push_back(&method);
  }
  return methods;
}

/// 0 for a stable run, 1 for drift, 2 for a gain of energy, 3 for divergence.
int colorCode(VerdictKind kind) {
  return std::max(static_cast<int>(kind) - static_cast<int>(VerdictKind::kDrift) + 1, 0);
}

void writeMap(const Options& options) {
  auto map = fmt::output_file(options.output + "/stability_map.csv");
  auto limits = fmt::output_file(options.output + "/stability_limit.csv");
  map.print("method,mass [kg],time step [s],verdict,code\n");
  limits.print("method,mass [kg],linear limit [s]\n");
  for (const Method* method : fixedStepMethods()) {
    for (int column = 0; column < cells(options); ++column) {
      const double mass = onScale(1e-4, 1e2, column, cells(options));
      const Scene scene = test::horizontalChain("", 11, mass);
      limits.print("{},{:.6g},{:.6g}\n", method->name, mass,
                   linearStepLimit(*method, scene.chain, kDuration));
      for (int row = 0; row < cells(options); ++row) {
        const double step = onScale(1e-4, 1.0, row, cells(options));
        const VerdictKind kind = verdictOfRun(scene, *method, step, kDuration, true).kind;
        map.print("{},{:.6g},{:.6g},{},{}\n", method->name, mass, step, toString(kind),
                  colorCode(kind));
      }
    }
  }
}

bool isStable(const Scene& scene, const Method& method, double time_step) {
  const auto kind = VerdictKind::kGainedEnergy;
  return verdictOfRun(scene, method, time_step, kDuration, true, kind).kind < kind;
}

/// Compares advised step sizes on random scenes with runs at slightly smaller and larger steps.
void writeAdvice(const Options& options) {
  auto table = fmt::output_file(options.output + "/stability_advice.csv");
  table.print(
      "scene,method,stable [s],accurate [s],linear [s],at 0.9,at 0.95,at 1.05,at 1.1,at linear\n");
  const unsigned scenes = options.smoke ? 3 : kScenes;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    const Scene scene = test::randomScene(seed);
    for (const Method* method : fixedStepMethods()) {
      const StepLimits limits =
          findStepLimits(*method, scene.chain, scene.start, 0.01, kDuration, 0.1);
      const double linear = linearStepLimit(*method, scene.chain, kDuration);
      table.print("{},{},{:.4g},{:.4g},{:.4g}", scene.name, method->name, limits.stable,
                  limits.accurate, linear);
      for (const double step : {0.9 * limits.stable, 0.95 * limits.stable, 1.05 * limits.stable,
                                1.1 * limits.stable, linear}) {
        const bool tried = std::isfinite(step) && kDuration / step < kMostSteps;
        table.print(",{}", tried ? isStable(scene, *method, step) ? "stable" : "unstable" : "");
      }
      table.print("\n");
    }
  }
}

}  // namespace

int run(const Options& options) {
  writeMap(options);
  writeAdvice(options);
  return 0;
}

}  // namespace spring_pendulum::benchmark

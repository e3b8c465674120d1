// Puts stability to the test.
// Two reports, as CSV in DIR:
// - stability_map.csv, stability_border.csv: the verdict on a grid of time steps against mass,
//   stiffness, damping and length of the chain, for each method with a fixed step, and the border
//   that the stability advice predicts;
// - stability_advice.csv: the largest step advised against the one found by bisection.
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <fmt/format.h>
#include <fmt/os.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "options.hpp"
#include "support/verdict_of_run.hpp"

namespace spring_pendulum::benchmark {
namespace {

using test::Scene;
using test::verdictOfRun;

constexpr double kDuration = 10.0;        // s, of a run on a map
constexpr double kAdviceDuration = 20.0;  // s, of a run against which advice is measured
constexpr double kMostSteps = 1e7;        // a longer run is left out, and said to be

/// One property of the exercise's chain of eleven particles, varied on a logarithmic scale.
struct Axis {
  std::string name;
  double least;
  double most;
  std::function<Scene(double)> scene;
};

std::vector<Axis> axes() {
  const auto with_spring = [](const SpringLaw& spring) {
    return test::horizontalChain("", 11, 1.0, spring);
  };
  return {
      {"mass", 1e-4, 1e2, [](double mass) { return test::horizontalChain("", 11, mass); }},
      {"stiffness", 1.0, 1e6,
       [=](double value) {
         return with_spring({value, 1.0, 1.0});
       }},
      {"damping", 1e-2, 1e3,
       [=](double value) {
         return with_spring({50.0, value, 1.0});
       }},
      {"particles", 2.0, 200.0,
       [](double value) { return test::horizontalChain("", std::llround(value), 1.0); }},
  };
}

/// Cells on a side of a map.
int cells(const Options& options) {
  return options.smoke ? 4 : 48;
}

double onScale(double least, double most, int cell, int cells) {
  return least * std::pow(most / least, static_cast<double>(cell) / (cells - 1));
}

std::vector<const Method*> fixedStepMethods() {
  std::vector<const Method*> methods;
  for (const Method& method : methodTable()) {
    if (method.control == StepControl::kFixed) methods.push_back(&method);
  }
  return methods;
}

void writeMaps(const Options& options) {
  auto map = fmt::output_file(options.output + "/stability_map.csv");
  auto border = fmt::output_file(options.output + "/stability_border.csv");
  map.print("axis,method,value,time_step [s],verdict,code\n");
  border.print("axis,method,value,largest step [s],spring step [s]\n");
  for (const Axis& axis : axes()) {
    for (const Method* method : fixedStepMethods()) {
      for (int column = 0; column < cells(options); ++column) {
        const double value = onScale(axis.least, axis.most, column, cells(options));
        const Scene scene = axis.scene(value);
        const auto advice = adviseOnStability(*method, scene.chain, scene.start, 0.01, kDuration);
        border.print("{},{},{:.6g},{:.6g},{:.6g}\n", axis.name, method->name, value,
                     advice.largestStep(), advice.spring_step);
        for (int row = 0; row < cells(options); ++row) {
          const double step = onScale(1e-4, 1.0, row, cells(options));
          const VerdictKind kind = verdictOfRun(scene, *method, step, kDuration, true).kind;
          map.print("{},{},{:.6g},{:.6g},{},{}\n", axis.name, method->name, value, step,
                    toString(kind), static_cast<int>(kind));
        }
      }
    }
  }
}

bool holds(const Scene& scene, const Method& method, double time_step) {
  const auto kind = VerdictKind::kGainedEnergy;
  return verdictOfRun(scene, method, time_step, kAdviceDuration, false, kind).kind < kind;
}

/// The border between the steps that hold and those that do not, within 1 %.
double largestStepByBisection(const Scene& scene, const Method& method, double guess) {
  double good = guess;
  while (!holds(scene, method, good)) good /= 1.2;
  double bad = good * 1.2;
  while (holds(scene, method, bad)) bad *= 1.2;
  good = std::max(good, bad / 1.2);
  while (bad > 1.01 * good) {
    const double middle = std::sqrt(good * bad);
    (holds(scene, method, middle) ? good : bad) = middle;
  }
  return good;
}

void writeAdvice(const Options& options) {
  auto table = fmt::output_file(options.output + "/stability_advice.csv");
  table.print("scene,method,advised [s],decided by,bisected [s],ratio\n");
  const std::vector<Scene> scenes = test::stabilityScenes();
  const std::size_t count = options.smoke ? 2 : scenes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Scene& scene = scenes[i];
    for (const Method* method : fixedStepMethods()) {
      const auto advice =
          adviseOnStability(*method, scene.chain, scene.start, 0.01, kAdviceDuration);
      const double advised = advice.largestStep();
      const char* decider = advice.spring_step <= advice.swing_step ? "springs" : "swinging";
      table.print("\"{}\",{},{:.4g},{},", scene.name, method->name, advised, decider);
      if (std::isinf(advised) || kAdviceDuration / advised > kMostSteps) {
        table.print("not measured,\n");
        continue;
      }
      const double bisected = largestStepByBisection(scene, *method, advised);
      table.print("{:.4g},{:.3f}\n", bisected, advised / bisected);
    }
  }
}

}  // namespace

int run(const Options& options) {
  writeAdvice(options);
  writeMaps(options);
  return 0;
}

}  // namespace spring_pendulum::benchmark

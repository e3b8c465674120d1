// The promise about tolerances, put to the test: every error-controlled method, every scene whose
// exact motion is known, a tolerance a decade from 1e-3 to 1e-10 m. The largest position error at
// any time with a reference solution may be ten times the tolerance.
//
// Every point runs in a process of its own; one that needs more processor time than --limit is
// recorded as not run to its end. Ends with status 1 if a promise is broken.
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "isolated.hpp"
#include "options.hpp"
#include "result_file.hpp"
#include "stopwatch.hpp"
#include "support/reference.hpp"

namespace spring_pendulum::benchmark {
namespace {

constexpr double kPromise = 10.0;  // tolerances

constexpr const char* kScenes[] = {"single_vertical", "two_masses_45deg", "horizontal_11",
                                   "horizontal_1000", "light_100",        "lighter_100",
                                   "alternating_50",  "feather_50"};

struct Case {
  std::string scene;
  const Method* method = nullptr;
  int exponent = 0;  ///< the tolerance is 10^-exponent m
};

/// In s, those that have a file.
std::vector<int> referenceTimes(const std::string& scene) {
  std::vector<int> times;
  for (const int time : {1, 2, 5, 10, 20, 50}) {
    if (std::filesystem::exists(fmt::format("{}/reference/{}_t{}.txt", TEST_DATA_DIR, scene, time)))
      times.push_back(time);
  }
  return times;
}

/// Runs in a process of its own: the worst error in tolerances and its time, force evaluations and
/// s of processor time until the last time.
std::string measure(const Case& one) {
  const test::Scene scene = test::referenceScene(one.scene);
  const double tolerance = std::pow(10.0, -one.exponent);
  const auto integrator = makeIntegrator(one.method->name, scene.chain, {tolerance});
  State state = scene.start;
  double worst = 0.0;
  int worst_time = 0;
  int now = 0;
  const Stopwatch stopwatch;
  for (const int time : referenceTimes(one.scene)) {
    integrator->advance(state, 1.0, time - now);
    now = time;
    const State exact = test::referenceSolution(one.scene, time);
    const double ratio = test::positionError(state, exact) / tolerance;
    if (ratio > worst || std::isnan(ratio)) {
      worst = ratio;
      worst_time = time;
    }
  }
  return fmt::format("{:.3g},{},{},{:.3g}", worst, worst_time, integrator->forceEvaluations(),
                     stopwatch.alone());
}

/// \returns whether the promise is kept, as far as the case was run
bool runCase(const Case& one, double limit, ResultFile& file) {
  const Isolated result = runIsolated([&one] { return measure(one); }, limit);
  const bool done = result.ending == Isolated::Ending::kDone;
  double ratio = 0.0;
  if (done) ratio = std::stod(result.text);
  const bool kept = ratio <= kPromise && result.ending != Isolated::Ending::kFailed;
  const char* status = !kept ? "broken" : done ? "kept" : "not run";
  file.add(fmt::format("{},{},1e-{:02},{},{},{}", one.scene, one.method->name, one.exponent, status,
                       done ? result.text : ",,,", done ? "" : quoted(result.text)));
  std::printf("%s, %s, 1e-%d: %s %s\n", one.scene.c_str(), one.method->name.data(), one.exponent,
              status, result.text.c_str());
  return kept;
}

}  // namespace

int run(const Options& options) {
  ResultFile file(options.output + "/tolerance.csv",
                  {"Largest position error over the tolerance asked for, at all times with a",
                   "reference solution. The promise is 10."},
                  "scene,method,tolerance_m,promise,worst_error_in_tolerances,at_s,"
                  "force_evaluations,seconds,note");
  bool all_kept = true;
  for (const char* scene : kScenes) {
    if (!options.scene.empty() && scene != options.scene) continue;
    if (options.smoke && scene != std::string("horizontal_11")) continue;
    for (const Method& method : methodTable()) {
      if (method.control != StepControl::kErrorControlled) continue;
      if (!options.peer.empty() && method.name != options.peer) continue;
      for (int exponent = 3; exponent <= (options.smoke ? 5 : 10); ++exponent) {
        all_kept = runCase({scene, &method, exponent}, options.limit, file) && all_kept;
      }
    }
  }
  return all_kept ? 0 : 1;
}

}  // namespace spring_pendulum::benchmark

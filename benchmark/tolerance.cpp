// Tests the promise about tolerances: every error-controlled method, every scene with a reference
// solution, tolerances 1e-3, 1e-4, ..., 1e-10 m. The position error may be at most ten tolerances
// at all times of the reference.
//
// Then the same on random scenes, down to 1e-9 m, with the oracle of the tests as reference. Scenes
// on which perturbations of the start grow more than a hundredfold are measured without a promise.
//
// Every point runs in a separate process; one that needs more processor time than --limit is
// recorded as incomplete. Ends with status 1 if the promise is broken.
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
#include "support/exact_motion.hpp"
#include "support/random_scenes.hpp"
#include "support/reference.hpp"

namespace spring_pendulum::benchmark {
namespace {

constexpr double kPromise = 10.0;  // tolerances

constexpr unsigned kRandomScenes = 155;
constexpr double kInterval = 0.5;  // s, between comparisons on random scenes
constexpr int kComparisons = 10;
constexpr double kOracleBudget = 8.0;     // s per scene
constexpr double kLargestGrowth = 100.0;  // growth of perturbations of the start
constexpr double kRandomLimit = 2.0;      // s of processor time per run

constexpr const char* kScenes[] = {"single_vertical", "two_masses_45deg", "horizontal_11",
                                   "horizontal_1000", "light_100",        "lighter_100",
                                   "alternating_50",  "feather_50"};

struct Case {
  std::string scene;
  const Method* method = nullptr;
  int exponent = 0;  ///< the tolerance is 10^-exponent m
};

/// Runs in a separate process. Returns the worst error in tolerances and its time, the number of
/// force evaluations, and the processor time in s.
std::string measure(const Case& one) {
  const test::Scene scene = test::referenceScene(one.scene);
  const double tolerance = std::pow(10.0, -one.exponent);
  const auto integrator = makeIntegrator(*one.method, scene.chain, {tolerance});
  State state = scene.start;
  double worst = 0.0;
  int worst_time = 0;
  int now = 0;
  const Stopwatch stopwatch;
  for (const int time : test::readReferenceTable(TEST_DATA_DIR "/reference", one.scene).times) {
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

constexpr const char* kColumns =
    "scene,method,tolerance_m,promise,worst_error_in_tolerances,at_s,force_evaluations,seconds,"
    "note";

/// \returns whether the promise is kept in the part of the case that was run
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

/// Like `measure`, with the oracle as reference.
std::string measureRandom(const test::Scene& scene, const test::ExactMotion& exact,
                          const Method& method, double tolerance) {
  const auto integrator = makeIntegrator(method, scene.chain, {tolerance});
  State state = scene.start;
  double worst = 0.0;
  int worst_at = 0;
  const Stopwatch stopwatch;
  for (int n = 0; n < kComparisons; ++n) {
    integrator->advance(state, kInterval, 1);
    const double error = test::positionError(state, exact.states[static_cast<std::size_t>(n)]);
    if (error <= worst * tolerance) continue;
    worst = error / tolerance;
    worst_at = n + 1;
  }
  return fmt::format("{:.3g},{},{},{:.3g}", worst, worst_at * kInterval,
                     integrator->forceEvaluations(), stopwatch.alone());
}

/// All tolerances, from coarse to fine, until a run takes too long.
bool runRandomScene(unsigned seed, const Method& method, const test::ExactMotion& exact, int finest,
                    ResultFile& file) {
  const test::Scene scene = test::randomScene(seed);
  const std::string family = scene.name.substr(0, scene.name.rfind(' '));
  const bool sensitive = exact.growth > kLargestGrowth;
  bool all_kept = true;
  bool too_slow = false;
  for (int exponent = 3; exponent <= finest; ++exponent) {
    const double tolerance = std::pow(10.0, -exponent);
    Isolated result{Isolated::Ending::kTooSlow, ""};
    if (!too_slow) {
      result =
          runIsolated([&] { return measureRandom(scene, exact, method, tolerance); }, kRandomLimit);
    }
    const bool done = result.ending == Isolated::Ending::kDone;
    too_slow = result.ending == Isolated::Ending::kTooSlow;
    const bool kept = too_slow || (done && std::stod(result.text) <= kPromise);
    const char* status = sensitive ? "sensitive" : !kept ? "broken" : too_slow ? "not run" : "kept";
    file.add(fmt::format("{},{},1e-{:02},{},{},{}", family, method.name, exponent, status,
                         done ? result.text : ",,,",
                         quoted(fmt::format("seed {}, growth {:.3g}", seed, exact.growth))));
    all_kept = all_kept && (kept || sensitive);
  }
  return all_kept;
}

bool runRandomScenes(const Options& options) {
  ResultFile file(options.output + "/tolerance_random.csv",
                  {"Largest position error over the tolerance asked for on random scenes, 5 s.",
                   "The promise is 10 where small changes of the start grow at most 100 times."},
                  kColumns);
  bool all_kept = true;
  int unsolved = 0;
  const unsigned scenes = options.smoke ? 3 : kRandomScenes;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    const auto exact =
        test::exactMotion(test::randomScene(seed), kInterval, kComparisons, kOracleBudget);
    if (!exact) ++unsolved;
    if (!exact) continue;
    for (const Method& method : methodTable()) {
      if (method.hasFixedStep()) continue;
      if (!options.peer.empty() && method.name != options.peer) continue;
      all_kept = runRandomScene(seed, method, *exact, options.smoke ? 5 : 9, file) && all_kept;
    }
  }
  std::printf("random scenes: %u, too costly for the oracle: %d\n", scenes, unsolved);
  return all_kept;
}

}  // namespace

int run(const Options& options) {
  ResultFile file(options.output + "/tolerance.csv",
                  {"Largest position error over the tolerance asked for, at all times with a",
                   "reference solution. The promise is 10."},
                  kColumns);
  bool all_kept = true;
  for (const char* scene : kScenes) {
    if (!options.scene.empty() && scene != options.scene) continue;
    if (options.smoke && scene != std::string("horizontal_11")) continue;
    for (const Method& method : methodTable()) {
      if (method.hasFixedStep()) continue;
      if (!options.peer.empty() && method.name != options.peer) continue;
      for (int exponent = 3; exponent <= (options.smoke ? 5 : 10); ++exponent) {
        all_kept = runCase({scene, &method, exponent}, options.limit, file) && all_kept;
      }
    }
  }
  const bool wants_random = options.scene.empty() || options.scene == "random";
  if (wants_random) all_kept = runRandomScenes(options) && all_kept;
  return all_kept ? 0 : 1;
}

}  // namespace spring_pendulum::benchmark

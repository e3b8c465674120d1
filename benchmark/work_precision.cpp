// Work-precision diagrams: run time and force evaluations of every method of this package and of
// every peer against the true error, for a range of step sizes and tolerances, on all scenes with a
// reference solution.
//
// Only the final state is computed, and the construction of a solver is not timed. Every point runs
// in a separate process, several times, in several passes over all points of a scene. The least
// time is used, as other load on the machine only adds to it; passes spread a longer disturbance
// over all methods.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "isolated.hpp"
#include "options.hpp"
#include "peer.hpp"
#include "result_file.hpp"
#include "scenes.hpp"
#include "stopwatch.hpp"

namespace spring_pendulum::benchmark {
namespace {

struct Point {
  std::string status = "ok";
  std::string note;
  double seconds = std::numeric_limits<double>::infinity();
  double error = std::numeric_limits<double>::infinity();
  long long evaluations = 0;
};

double secondsOf(Peer& peer) {
  peer.reset();
  const Stopwatch stopwatch;
  peer.advance();
  return stopwatch.alone();
}

/// Runs in a separate process.
std::string measure(const ReferenceScene& scene, const PeerRow& row, const Run& run,
                    double budget) {
  const std::unique_ptr<Peer> peer = row.make(scene.problem, run);
  const long long before = peer->forceEvaluations();
  double least = secondsOf(*peer);
  const long long evaluations = peer->forceEvaluations() - before;
  const double error = positionError(peer->state(), scene.exact);
  if (!std::isfinite(error)) return fmt::format("{} inf {}", least, evaluations);
  double spent = least;
  for (int count = 1; spent < budget || (count < 3 && spent < 10.0 * budget); ++count) {
    const double seconds = secondsOf(*peer);
    least = std::min(least, seconds);
    spent += seconds;
  }
  return fmt::format("{} {} {}", least, error, evaluations);
}

Point measured(const ReferenceScene& scene, const PeerRow& row, const Run& run,
               const Options& options) {
  Point point;
  const double limit = options.limit + 10.0 * options.budget;
  const Isolated result =
      runIsolated([&] { return measure(scene, row, run, options.budget); }, limit);
  point.note = result.text;
  if (result.ending == Isolated::Ending::kTooSlow) point.status = "too slow";
  if (result.ending == Isolated::Ending::kFailed) point.status = "failed";
  if (result.ending != Isolated::Ending::kDone) return point;
  const std::vector<double> numbers = numbersOf(result.text);
  point.seconds = numbers.at(0);
  point.error = numbers.at(1);
  point.evaluations = std::llround(numbers.at(2));
  const bool finite = std::isfinite(point.error);
  point.status = finite ? "ok" : "failed";
  point.note = finite ? "" : "the motion diverged";
  return point;
}

constexpr double kBestError = 2e-12;  // m; smaller errors are rounding errors

/// Step sizes from about 80 ms, two per octave; each divides the duration.
std::vector<Run> fixedRuns(double duration, bool smoke) {
  std::vector<Run> runs;
  for (int k = 0; k < 40; k += smoke ? 12 : 1) {
    const double refinement = std::pow(2.0, 0.5 * k);
    const auto steps = static_cast<std::int64_t>(std::lround(duration / 0.08 * refinement));
    runs.push_back({duration / static_cast<double>(steps), steps, 0.0, 1});
  }
  return runs;
}

/// Tolerances from 100 to 1e-12, two per decade. Large ones are needed because the error of some
/// methods is far below the tolerance.
std::vector<Run> controlledRuns(double duration, bool smoke) {
  std::vector<Run> runs;
  for (int k = smoke ? 2 : -4; k <= 24; k += smoke ? 10 : 1) {
    runs.push_back({duration, 1, std::pow(10.0, -0.5 * k), 1});
  }
  return runs;
}

struct Line {
  const PeerRow* row;
  std::vector<Run> runs;
  std::vector<Point> points;
};

/// A first pass runs the points of a method in order and stops where later ones cannot improve.
void firstPass(const ReferenceScene& scene, Line& line, const Options& options) {
  int worthless = 0;
  for (std::size_t k = 0; k < line.runs.size(); ++k) {
    const bool fixed = line.row->stepping == Stepping::kFixed;
    Point point;
    const double previous = k > 0 && fixed ? line.points[k - 1].seconds : 0.0;
    if (std::isfinite(previous) && 1.5 * previous > options.limit) {
      point.status = "too slow";
      point.note = "more steps than at the last point";
    } else {
      point = measured(scene, *line.row, line.runs[k], options);
    }
    line.points.push_back(point);
    if (point.status == "too slow") ++worthless;
    const Point& last = line.points[k > 0 ? k - 1 : 0];
    const bool more_work =
        static_cast<double>(point.evaluations) > 1.05 * static_cast<double>(last.evaluations);
    const bool rounding = more_work && point.error < 1e-8 && point.error > 0.7 * last.error;
    if (point.status == "ok" && (point.error < kBestError || rounding)) worthless += 2;
    if (worthless >= 2 || (fixed && point.status == "too slow")) break;
  }
  line.runs.resize(line.points.size());
}

void laterPass(const ReferenceScene& scene, Line& line, const Options& options) {
  for (std::size_t k = 0; k < line.runs.size(); ++k) {
    Point& point = line.points[k];
    if (point.status != "ok" || point.seconds > 5.0 * options.budget) continue;
    const Point again = measured(scene, *line.row, line.runs[k], options);
    if (again.status == "ok") point.seconds = std::min(point.seconds, again.seconds);
  }
}

/// Largest acceptable best error of a method: it must solve the same problem as the reference.
constexpr double kAgreement = 2e-2;  // m

bool agrees(const ReferenceScene& scene, const Line& line) {
  double best = std::numeric_limits<double>::infinity();
  for (const Point& point : line.points) best = std::min(best, point.error);
  if (best <= kAgreement) return true;
  const bool every_point_hampered =
      std::all_of(line.points.begin(), line.points.end(),
                  [](const Point& point) { return point.status != "ok"; });
  const Point& last = line.points.back();
  std::fprintf(stderr, "%s, %s: no point within %g m (best %g)%s%s\n", scene.problem.name.c_str(),
               line.row->name.c_str(), kAgreement, best, every_point_hampered ? ": " : "",
               every_point_hampered ? last.note.c_str() : "");
  return every_point_hampered || last.status == "too slow";
}

void write(const ReferenceScene& scene, const Line& line, ResultFile& file) {
  for (std::size_t k = 0; k < line.points.size(); ++k) {
    const Run& run = line.runs[k];
    const Point& point = line.points[k];
    const bool fixed = line.row->stepping == Stepping::kFixed;
    const bool timed = std::isfinite(point.seconds);
    file.add(fmt::format("{},{},{},{},{:.6g},{},{},{},{},{}", scene.problem.name, line.row->library,
                         quoted(line.row->name), fixed ? "step" : "tolerance",
                         fixed ? run.time_step : run.tolerance, point.status,
                         timed ? fmt::format("{:.6g}", 1e3 * point.seconds) : "",
                         point.status == "ok" ? fmt::format("{:.4g}", point.error) : "",
                         timed ? fmt::to_string(point.evaluations) : "", quoted(point.note)));
  }
}

bool runScene(const ReferenceScene& scene, const Options& options, ResultFile& file) {
  std::vector<Line> lines;
  for (const PeerRow& row : allPeers()) {
    if (!options.peer.empty() && row.library != options.peer && row.name != options.peer) continue;
    lines.push_back({&row,
                     row.stepping == Stepping::kFixed
                         ? fixedRuns(scene.duration, options.smoke)
                         : controlledRuns(scene.duration, options.smoke),
                     {}});
  }
  bool all_agree = true;
  for (Line& line : lines) {
    firstPass(scene, line, options);
    all_agree = agrees(scene, line) && all_agree;
    std::printf("%s: %s done\n", scene.problem.name.c_str(), line.row->name.c_str());
  }
  for (int pass = 1; pass < options.passes; ++pass) {
    for (Line& line : lines) laterPass(scene, line, options);
  }
  for (const Line& line : lines) write(scene, line, file);
  return all_agree;
}

}  // namespace

int run(const Options& options) {
  ResultFile file(
      options.output + "/work_precision.csv",
      {"Time and force evaluations against the true error: largest distance of a particle from the",
       "reference solution at the end. One thread; least processor time of several runs; making a",
       "solver is not timed. Points that failed or took too long stand here too."},
      "scene,library,method,control,value_s_or_m,status,time_ms,error_m,force_evaluations,note");
  bool all_agree = true;
  for (const ReferenceScene& scene : referenceScenes()) {
    if (!options.scene.empty() && scene.problem.name != options.scene) continue;
    if (options.smoke && scene.problem.name != "horizontal_11") continue;
    all_agree = runScene(scene, options, file) && all_agree;
  }
  return all_agree ? 0 : 1;
}

}  // namespace spring_pendulum::benchmark

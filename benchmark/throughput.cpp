// Throughput: nanoseconds per spring force of the classical Runge-Kutta method, for chains from 3
// to ten million particles, ten steps per call.
//
// The result is ratios between candidates, so each candidate is timed once per round, and the
// median over the rounds is used. A disturbance then affects all candidates alike. (Google
// Benchmark finishes one candidate before it begins the next.)
//
// Before the timing, each candidate runs in a separate process and must reach the same state as the
// plain structure-of-arrays loop.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "busy_sibling.hpp"
#include "isolated.hpp"
#include "options.hpp"
#include "peer.hpp"
#include "peers/divider_bound.hpp"
#include "result_file.hpp"
#include "scenes.hpp"
#include "stopwatch.hpp"

namespace spring_pendulum::benchmark {
namespace {

// A different order of operations changes only rounding errors. The limit for GSL is larger, as its
// step doubling takes two half steps.
constexpr double kAgreement = 1e-10;       // m and m/s
constexpr double kAgreementGsl = 1e-5;     // m and m/s
constexpr double kSampleTime = 2e-3;       // s, least time per candidate and round
constexpr double kProbeLimit = 60.0;       // s, for constructing a peer and one run
constexpr std::size_t kLarge = 1'000'000;  // above, peers exist only while they are timed

struct Candidate {
  const PeerRow* row = nullptr;
  Run run;
  std::string status = "ok";
  std::string note;
  double difference = 0.0;      // from the plain loop
  double seconds_a_call = 0.0;  // measured by the probe
  std::unique_ptr<Peer> peer;
  std::vector<double> samples;  // ns per spring force
  double evaluations_a_step = 0.0;
};

const PeerRow& baseline() {
  return *std::find_if(allPeers().begin(), allPeers().end(),
                       [](const PeerRow& row) { return row.name == "structure of arrays"; });
}

/// Runs in a separate process. Returns the seconds per call and the difference from the plain loop.
std::string runOnce(const Problem& problem, const Candidate& candidate) {
  const int calls = problem.size() < kLarge ? 10 : 1;
  Run run = candidate.run;
  if (problem.size() >= kLarge) run.steps = 1;
  const auto peer = candidate.row->make(problem, run);
  peer->reset();
  peer->advance();
  peer->reset();
  const Stopwatch stopwatch;
  for (int call = 0; call < calls; ++call) peer->advance();
  const double seconds = stopwatch.elapsed() / calls;
  const auto plain = baseline().make(problem, run);
  for (int call = 0; call < calls; ++call) plain->advance();
  const double difference = stateDifference(peer->state(), plain->state());
  const std::int64_t times_as_many = candidate.run.steps / run.steps;
  return fmt::format("{} {}", seconds * static_cast<double>(times_as_many), difference);
}

void probe(const Problem& problem, Candidate& candidate) {
  const Isolated result = runIsolated([&] { return runOnce(problem, candidate); }, kProbeLimit);
  candidate.note = result.text;
  if (result.ending == Isolated::Ending::kTooSlow) candidate.status = "too slow";
  if (result.ending == Isolated::Ending::kFailed) candidate.status = "failed";
  if (result.ending != Isolated::Ending::kDone) return;
  candidate.note.clear();
  const std::vector<double> numbers = numbersOf(result.text);
  candidate.seconds_a_call = numbers.at(0);
  candidate.difference = numbers.at(1);
  const double allowed = candidate.row->library == "GSL" ? kAgreementGsl : kAgreement;
  if (candidate.difference > allowed) {
    candidate.status = "disagrees";
    candidate.note = fmt::format("more than {} m or m/s from the plain loop", allowed);
  }
}

void sample(const Problem& problem, Candidate& candidate) {
  if (!candidate.peer) candidate.peer = candidate.row->make(problem, candidate.run);
  Peer& peer = *candidate.peer;
  peer.reset();
  peer.advance();
  const auto calls = static_cast<std::int64_t>(kSampleTime / candidate.seconds_a_call) + 1;
  const std::int64_t before = peer.forceEvaluations();
  const Stopwatch stopwatch;
  for (std::int64_t call = 0; call < calls; ++call) peer.advance();
  // Wall-clock time, as the processor time of other threads is not measured.
  const double seconds = candidate.run.threads == 1 ? stopwatch.alone() : stopwatch.elapsed();
  const auto evaluations = static_cast<double>(peer.forceEvaluations() - before);
  candidate.samples.push_back(1e9 * seconds / evaluations /
                              static_cast<double>(problem.size() - 1));
  candidate.evaluations_a_step = evaluations / static_cast<double>(calls * candidate.run.steps);
  if (problem.size() > kLarge) candidate.peer.reset();
}

/// \param library to compare with the plain loops; empty: all
std::vector<Candidate> candidatesFor(std::size_t particles, const std::string& library) {
  std::vector<Candidate> candidates;
  for (const PeerRow& row : allPeers()) {
    if (!row.classical_runge_kutta) continue;
    if (!library.empty() && row.library != library && row.library != "plain") continue;
    const bool own = row.library == "own";
    Candidate candidate;
    candidate.row = &row;
    // Only this package gains from several steps per call; the others are timed with one.
    candidate.run.steps = own || particles < kLarge ? 10 : 1;
    candidates.push_back(std::move(candidate));
    if (!own) continue;
    for (const bool energy : {false, true}) {
      candidates.push_back({&row, candidates.front().run});
      candidates.back().run.threads = energy ? 1 : 0;
      candidates.back().run.energy = energy;
    }
  }
  return candidates;
}

void write(const Problem& problem, Candidate& candidate, ResultFile& file) {
  std::vector<double>& samples = candidate.samples;
  std::sort(samples.begin(), samples.end());
  const bool done = candidate.status == "ok";
  file.add(fmt::format(
      "{},{},{},{},{},{},{},{},{},{},{}", problem.size(), candidate.row->library,
      quoted(candidate.row->name + (candidate.run.energy ? " with the energy balance" : "")),
      candidate.run.threads == 0 ? "all" : "1", candidate.status,
      done ? fmt::format("{:.4g}", samples[samples.size() / 2]) : "",
      done ? fmt::format("{:.4g}", samples.front()) : "",
      done ? fmt::to_string(samples.size()) : "",
      done ? fmt::format("{:.4g}", candidate.evaluations_a_step) : "",
      done || candidate.status == "disagrees" ? fmt::format("{:.2g}", candidate.difference) : "",
      quoted(candidate.note)));
}

/// \param lost methods that failed with fewer particles, which are skipped
bool runSize(std::size_t particles, const Options& options, std::set<std::string>& lost,
             ResultFile& file) {
  const int smallest = particles < 100'000 ? 25 : particles <= kLarge ? 7 : 3;
  const int rounds = options.smoke ? 3 : smallest;
  const Problem problem = horizontalChain(particles);
  std::vector<Candidate> candidates = candidatesFor(particles, options.peer);
  bool all_agree = true;
  for (Candidate& candidate : candidates) {
    if (lost.count(candidate.row->name) > 0) {
      candidate.status = "failed";
      candidate.note = "as with fewer particles";
      continue;
    }
    probe(problem, candidate);
    if (candidate.status == "failed") lost.insert(candidate.row->name);
    if (candidate.status == "disagrees") all_agree = false;
    if (candidate.status != "ok") {
      std::fprintf(stderr, "%zu particles, %s: %s %s\n", particles, candidate.row->name.c_str(),
                   candidate.status.c_str(), candidate.note.c_str());
    }
  }
  for (int round = 0; round < rounds; ++round) {
    for (Candidate& candidate : candidates) {
      if (candidate.status == "ok") sample(problem, candidate);
    }
  }
  for (Candidate& candidate : candidates) write(problem, candidate, file);
  std::printf("%zu particles done\n", particles);
  return all_agree;
}

}  // namespace

int run(const Options& options) {
  std::optional<BusySibling> sibling;
  if (options.busy_sibling) sibling.emplace();
  ResultFile file(options.output + "/throughput.csv",
                  {"Classical Runge-Kutta method: nanoseconds per spring force, by chain length.",
                   "Candidates take turns; median and least of the rounds. `difference` is the",
                   "largest one from the plain structure-of-arrays loop after the first calls.",
                   fmt::format("divider bound: {:.3f} ns for a square root and a division alone",
                               dividerBound()),
                   sibling ? sibling->description() : "alone on the core, as far as known"},
                  "particles,library,method,threads,status,median_ns,least_ns,rounds,"
                  "force_evaluations_a_step,difference_m_or_m_per_s,note");
  bool all_agree = true;
  std::set<std::string> lost;
  std::vector<std::size_t> lengths = options.particles;
  if (lengths.empty()) {
    lengths = {3, 11, 17, 33, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000};
  }
  for (const std::size_t particles : lengths) {
    if (options.smoke && particles > 1'000) break;
    all_agree = runSize(particles, options, lost, file) && all_agree;
  }
  return all_agree ? 0 : 1;
}

}  // namespace spring_pendulum::benchmark

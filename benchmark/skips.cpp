// Time saved by each skip: a scene that does not need some work, and one that does.
#include "integration/fixed_step/explicit_runge_kutta.hpp"
#include "io/formats/frame_writer.hpp"
#include "simulation/judge.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "interleaved.hpp"
#include "options.hpp"
#include "result_file.hpp"
#include "scenes.hpp"

namespace spring_pendulum::benchmark {
namespace {

constexpr double kTimeStep = 0.01;        // s
constexpr std::int64_t kStepsACall = 10;  // a frame
constexpr double kForcesASample = 1e6;

Chain uniformChain(Eigen::Index size, double damping) {
  return {Eigen::VectorXd::Ones(size), SpringLaw{50.0, damping, 1.0}, 9.81};
}

State startOf(Eigen::Index size) {
  State state(size);
  state.x().setLinSpaced(0.0, static_cast<double>(size - 1));
  return state;
}

/// A chain that advances frame by frame.
class Carried {
 public:
  Carried(const Chain& chain, const IntegratorOptions& options)
      : Carried(chain,
                std::make_unique<ExplicitRungeKutta>(chain, kClassicalRungeKuttaTableau, options)) {
  }
  Carried(const Chain& chain, std::unique_ptr<Integrator> integrator)
      : integrator_(std::move(integrator)),
        state_(startOf(chain.size())),
        calls_(static_cast<std::int64_t>(kForcesASample /
                                         static_cast<double>(4 * kStepsACall * chain.size())) +
               1) {}

  void frame() { integrator_->advance(state_, kTimeStep, kStepsACall); }
  const State& state() const { return state_; }
  const Integrator& integrator() const { return *integrator_; }
  std::int64_t calls() const { return calls_; }

  void reset() {
    state_ = startOf(state_.size());
    integrator_->restart();
  }
  void run() {
    for (std::int64_t call = 0; call < calls_; ++call) frame();
  }

 private:
  std::unique_ptr<Integrator> integrator_;
  State state_;
  std::int64_t calls_;
};

struct Pair {
  std::string skip;
  Timing with, without;
  double forces;  ///< spring forces per timing
};

double forcesOf(const Carried& carried) {
  return static_cast<double>(4 * kStepsACall * carried.calls() * (carried.state().size() - 1));
}

/// A skip of the engine: a chain without the term and one with it.
Pair timeEngineSkip(const std::string& name, const Chain& chain, const Chain& with_term,
                    int rounds) {
  IntegratorOptions options;
  options.threads = 1;
  Carried with(chain, options);
  Carried without(with_term, options);
  const auto timings = timeInTurns({{"with", [&] { with.reset(); }, [&] { with.run(); }},
                                    {"without", [&] { without.reset(); }, [&] { without.run(); }}},
                                   rounds, Time::kAlone);
  return {name, timings[0], timings[1], forcesOf(with)};
}

/// Without energy balance: neither the dissipated energy nor the balance is computed.
Pair timeEnergySkip(Eigen::Index size, int rounds) {
  const Chain chain = uniformChain(size, 1.0);
  const auto integrator = [&](bool track) {
    IntegratorOptions options;
    options.threads = 1;
    options.track_dissipation = track;
    return makeIntegrator("Runge-Kutta-4", chain, options);
  };
  Carried with(chain, integrator(false));
  Carried without(chain, integrator(true));
  Judge plain(chain, with.state(), JudgeOptions{false});
  Judge balanced(chain, without.state(), JudgeOptions{true});
  const auto run = [](Carried& carried, Judge& judge) {
    for (std::int64_t call = 0; call < carried.calls(); ++call) {
      carried.frame();
      judge.judge(0.0, carried.state(), carried.integrator().dissipatedEnergy(), nullptr);
    }
  };
  const auto timings =
      timeInTurns({{"with", [&] { with.reset(); }, [&] { run(with, plain); }},
                   {"without", [&] { without.reset(); }, [&] { run(without, balanced); }}},
                  rounds, Time::kAlone);
  return {"no energy balance", timings[0], timings[1], forcesOf(with)};
}

/// Without frame files.
Pair timeFramesSkip(Eigen::Index size, const std::string& folder, int rounds) {
  const Chain chain = uniformChain(size, 1.0);
  Carried carried(chain, IntegratorOptions{});
  const std::string frames = folder + "/skips_frames";
  const auto timings = timeInTurns({{"with", [&] { carried.reset(); }, [&] { carried.run(); }},
                                    {"without", [&] { carried.reset(); },
                                     [&] {
                                       FrameWriter writer(frames);
                                       for (std::int64_t call = 0; call < carried.calls(); ++call) {
                                         carried.frame();
                                         writer.write(call, carried.state());
                                       }
                                       writer.finish();
                                     }}},
                                   rounds, Time::kElapsed);
  std::filesystem::remove_all(frames);
  return {"no frame files", timings[0], timings[1], forcesOf(carried)};
}

std::vector<Pair> timePairs(Eigen::Index size, const Options& options) {
  const int rounds = options.smoke ? 3 : 25;
  const Chain usual = uniformChain(size, 1.0);
  std::vector<Pair> pairs;
  pairs.push_back(timeEngineSkip("no damping", uniformChain(size, 0.0), usual, rounds));
  pairs.push_back(timeEnergySkip(size, rounds));
  pairs.push_back(timeFramesSkip(size, options.output, std::min(rounds, 5)));
  return pairs;
}

}  // namespace

int run(const Options& options) {
  ResultFile file(
      options.output + "/skips.csv",
      {"What each skip saves: Runge-Kutta-4, one thread, 10 steps a call, time per spring",
       "force with and without the skip (medians of runs that take turns). For a skip of",
       "the engine, the chain without the skip has damping."},
      "skip,particles,with_ns,without_ns,saved_percent");
  for (const Eigen::Index size : {11, 1000, 100000}) {
    for (const Pair& pair : timePairs(size, options)) {
      const double with = 1e9 * pair.with.median / pair.forces;
      const double without = 1e9 * pair.without.median / pair.forces;
      file.add(fmt::format("{},{},{:.4g},{:.4g},{:.1f}", quoted(pair.skip), size, with, without,
                           100.0 * (1.0 - with / without)));
    }
  }
  return 0;
}

}  // namespace spring_pendulum::benchmark

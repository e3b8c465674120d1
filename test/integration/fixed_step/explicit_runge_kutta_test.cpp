// The engine gives the bits of the plain code and of recorded hashes for all instruction sets,
// numbers of threads, block sizes and steps per call, whatever it skips.
#include "integration/fixed_step/explicit_runge_kutta.hpp"

#include "integration/fixed_step/plain_runge_kutta.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <random>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr double kTimeStep = 0.005;

/// A folded and bent chain, with small velocities everywhere.
State bentChain(Eigen::Index size) {
  std::mt19937 random(5);
  State state(size);
  for (Eigen::Index i = 1; i < size; ++i) {
    const auto number = [&] { return static_cast<double>(random() % 2001) / 1000.0 - 1.0; };
    state.x()[i] = state.x()[i - 1] + 0.75 + 0.5 * number();
    state.y()[i] = state.y()[i - 1] + number();
    state.vx()[i] = 0.5 * number();
    state.vy()[i] = 0.5 * number();
  }
  return state;
}

/// One scene that needs everything, and one that lets the engine skip all it can.
struct Kind {
  const char* name;
  bool needs_all;
};
constexpr Kind kKinds[] = {{"that needs everything", true}, {"that needs little", false}};

Chain chainOf(Eigen::Index size, const Kind& kind) {
  Eigen::VectorXd masses = Eigen::VectorXd::Ones(size);
  for (Eigen::Index i = 0; kind.needs_all && i < size; ++i)
    masses[i] = 0.5 + static_cast<double>(i * 7919 % 1001) / 1000.0;
  return Chain(masses, {50.0, kind.needs_all ? 1.0 : 0.0, 1.0}, kind.needs_all ? 9.81 : 0.0);
}

/// All methods that the engine runs.
std::vector<const Method*> methods() {
  std::vector<const Method*> rows;
  for (const Method& method : methodTable())
    if (method.hasFixedStep() && method.tableau != nullptr) rows.push_back(&method);
  return rows;
}
constexpr Eigen::Index kShortChains[] = {1, 2, 3, 7, 8, 9, 11, 64, 1000};
/// Above all shorter chains: lengths around the ends of one, two and three tiles of the kernels.
constexpr Eigen::Index kTiledChains[] = {127, 128, 129, 130, 200, 255, 256, 257, 258,
                                         259, 264, 265, 266, 383, 384, 385, 386, 393};
constexpr Eigen::Index kLongChain = 100003;
constexpr int kSteps = 12;
constexpr int kStepsOfLongChain = 3;

/// FNV-1a over the bytes of a state, continuing `hash`.
std::uint64_t hashOf(const State& state, std::uint64_t hash = 0xcbf29ce484222325U) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(state.values().data());
  const auto count = static_cast<std::size_t>(state.values().size()) * sizeof(double);
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3U;
  return hash;
}

State stateAfter(Integrator& integrator, State state, int steps, int steps_a_call) {
  for (int done = 0; done < steps; done += steps_a_call)
    integrator.advance(state, kTimeStep, std::min(steps_a_call, steps - done));
  return state;
}

bool sameBits(const State& a, const State& b) {
  const auto bytes = static_cast<std::size_t>(a.values().size()) * sizeof(double);
  return a.size() == b.size() && std::memcmp(a.values().data(), b.values().data(), bytes) == 0;
}

/// Ways to run the engine; all combinations are run.
struct Ways {
  std::vector<std::pair<int, Eigen::Index>> threads_and_block_sizes;
  std::vector<int> steps_a_call;
};

/// Runs the engine in all these ways with every instruction set and compares the bits.
void expectSameBits(const Method& method, const Kind& kind, const State& start, int steps,
                    const Ways& ways, bool track_dissipation = false) {
  const Chain chain = chainOf(start.size(), kind);
  PlainRungeKutta plain(chain, *method.tableau, track_dissipation);
  const State expected = stateAfter(plain, start, steps, steps);
  for (const ChainKernels* kernels : supportedChainKernels())
    for (const auto& [threads, block_size] : ways.threads_and_block_sizes) {
      ExplicitRungeKutta engine(chain, *method.tableau, {1e-6, track_dissipation, threads},
                                {block_size, 1e-9, kernels});
      for (const int at_once : ways.steps_a_call) {
        engine.restart();
        EXPECT_TRUE(sameBits(stateAfter(engine, start, steps, at_once), expected))
            << method.name << ", " << start.size() << " particles, scene " << kind.name << ", "
            << kernels->name << ", " << threads << " threads, blocks of " << block_size << ", "
            << at_once << " steps a call";
        EXPECT_EQ(engine.dissipatedEnergy(), plain.dissipatedEnergy())
            << method.name << ", " << start.size() << " particles, " << kernels->name
            << ", blocks of " << block_size;
      }
    }
}

TEST(ExplicitRungeKutta, HasTheBitsOfThePlainCodeHoweverItIsRun) {
  const Ways ways{{{1, 4096}, {1, 16}, {2, 16}, {3, 64}}, {kSteps, 5}};
  for (const Method* method : methods())
    for (const Kind& kind : kKinds) {
      for (const Eigen::Index size : kShortChains)
        for (const bool track_dissipation : {false, true})
          expectSameBits(*method, kind, bentChain(size), kSteps, ways, track_dissipation);
    }
}

TEST(ExplicitRungeKutta, HasTheBitsOfThePlainCodeForEveryNumberOfBlocks) {
  for (const Method* method : methods()) {
    std::vector<Eigen::Index> sizes(120);
    std::iota(sizes.begin(), sizes.end(), 1);
    sizes.insert(sizes.end(), std::begin(kTiledChains), std::end(kTiledChains));
    for (const Eigen::Index size : sizes)
      for (const Kind& kind : kKinds)
        expectSameBits(*method, kind, bentChain(size), 3, {{{1, 4096}}, {3}}, size % 2 == 0);
  }
}

TEST(ExplicitRungeKutta, HasTheBitsOfThePlainCodeOnALongChain) {
  const State start = bentChain(kLongChain);
  for (const Method* method : methods()) {
    expectSameBits(*method, kKinds[0], start, 2, {{{1, 4096}, {3, 20000}}, {2}});
    expectSameBits(*method, kKinds[1], start, 2, {{{2, 4096}}, {1}});
  }
  expectSameBits(findMethod("Runge-Kutta-4"), kKinds[0], start, 2, {{{1, 4096}, {3, 20000}}, {2}},
                 true);
}

// Recorded hashes. Record new ones after an intended change of the arithmetic.
TEST(ExplicitRungeKutta, GivesTheRecordedBits) {
  const std::map<std::string, std::uint64_t> expected{{"Euler", 0x4c46a64ae9807f8eU},
                                                      {"Runge-Kutta-2", 0x49745e6ce3e68c30U},
                                                      {"Runge-Kutta-4", 0x6239e3f06723fabeU}};
  for (const auto& [name, recorded] : expected) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const Kind& kind : kKinds)
      for (const Eigen::Index size : kShortChains) {
        const auto engine = makeIntegrator(name, chainOf(size, kind));
        hash = hashOf(stateAfter(*engine, bentChain(size), kSteps, kSteps), hash);
      }
    const auto engine = makeIntegrator(name, chainOf(kLongChain, kKinds[0]));
    hash = hashOf(stateAfter(*engine, bentChain(kLongChain), kStepsOfLongChain, 2), hash);
    EXPECT_EQ(hash, recorded) << name << ": 0x" << std::hex << hash;
  }
}

TEST(ExplicitRungeKutta, LeavesTheFixedParticleWhereItIsThoughItsNeighbourIsLost) {
  State state = bentChain(3);
  state.x()[1] = std::nan("");
  makeIntegrator("Runge-Kutta-4", chainOf(3, kKinds[0]))->advance(state, kTimeStep, 10);
  EXPECT_EQ(state.values().row(0).norm(), 0.0);
  EXPECT_TRUE(std::isnan(state.x()[2]));
}

TEST(ExplicitRungeKutta, StartsItsThreadsAnewInAForkedProcess) {
  const State start = bentChain(9000);
  auto engine = std::make_unique<ExplicitRungeKutta>(
      chainOf(9000, kKinds[0]), kClassicalRungeKuttaTableau, IntegratorOptions{1e-6, false, 2},
      EngineOptions{1024, 1e-9});
  const State expected = stateAfter(*engine, start, kSteps, kSteps);
  const pid_t child = fork();
  if (child == 0) {
    const bool same = sameBits(stateAfter(*engine, start, kSteps, kSteps), expected);
    engine.reset();
    _exit(same ? 0 : 1);
  }
  int status = 1;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace spring_pendulum

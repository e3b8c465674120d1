// Prints a hash of the motion, the energies, the position errors and the verdicts for each method, one
// method per line; a second hash is that of driven runs. Equal lines on two machines mean equal bits (scripts/test_arm64.sh).
#include "simulation/judge.hpp"
#include "simulation/reference_run.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

namespace spring_pendulum {
namespace {

constexpr double kTolerance = 1e-7;  // m
constexpr double kTimeStep = 0.005;  // s
constexpr int kSteps = 20;           ///< per frame

/// FNV-1a over the bytes of a number, continuing `hash`.
std::uint64_t hashOf(double number, std::uint64_t hash) {
  unsigned char bytes[sizeof(number)];
  std::memcpy(bytes, &number, sizeof(number));
  for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3U;
  return hash;
}

/// A zigzag in motion, with unequal masses.
State zigzag(Eigen::Index size) {
  State state(size);
  for (Eigen::Index i = 1; i < size; ++i) {
    state.x()[i] = 0.75 * static_cast<double>(i);
    state.y()[i] = i % 2 == 0 ? 0.0 : 0.6;
    state.vx()[i] = 0.125 * static_cast<double>(i % 5);
    state.vy()[i] = -0.375 * static_cast<double>(i % 3);
  }
  return state;
}

std::uint64_t hashOfRuns(const Method& method) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const Eigen::Index size : {1, 2, 3, 11, 40, 100}) {
    Eigen::VectorXd masses(size);
    for (Eigen::Index i = 0; i < size; ++i) masses[i] = 0.5 + static_cast<double>(i % 7) / 10.0;
    for (const double damping : {1.0, 0.0}) {
      const Chain chain(masses, {50.0, damping, 1.0}, 9.81);
      const auto integrator = method.make(method, chain, {kTolerance, true, 1});
      State state = zigzag(size);
      const double tolerance = method.hasFixedStep() ? 0.0 : kTolerance;
      ReferenceRun reference(chain, state, tolerance, true);
      Judge judge(chain, state, {true, method.symplectic ? kTimeStep : 0.0, tolerance});
      for (int frame = 1; frame <= 3; ++frame) {
        integrator->advance(state, kTimeStep, kSteps);
        reference.advance(kTimeStep, kSteps);
        reference.measure(integrator->work());
        const Verdict& verdict = judge.judge(kTimeStep * kSteps * frame, state,
                                             integrator->dissipatedEnergy(), &reference);
        for (Eigen::Index i = 0; i < size; ++i)
          for (Eigen::Index c = 0; c < 4; ++c) hash = hashOf(state.values()(i, c), hash);
        const EnergyEntry& entry = judge.entry();
        const PositionError& error = judge.positionError();
        for (const double number :
             {*entry.dissipated, entry.energy.kinetic, entry.energy.gravity, entry.energy.spring,
              entry.relative_gain, *entry.relative_residual, error.now, error.uncertainty,
              error.bound, static_cast<double>(verdict.kind)}) {
          hash = hashOf(number, hash);
        }
      }
    }
  }
  return hash;
}

/// The same with particles that are held and pushed, the second time in air.
std::uint64_t hashOfDrivenRuns(const Method& method) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const Eigen::Index size = 11;
  const Chain chain(Eigen::VectorXd::LinSpaced(size, 0.5, 1.5), {50.0, 1.0, 1.0}, 9.81);
  for (const double air_drag : {0.0, 0.25}) {
    State state = zigzag(size);
    for (int input = 0; input < 10; ++input) {
      const double push = 0.25 * input - 1.0;
      const Chain driven =
          Chain(chain.masses(), {chain.spring(), chain.gravity(), air_drag})
              .drivenBy(
                  {{{0, {push, 0.5}}, {4, {-0.75, push}}, {10, {1.0, -push}}}, {{7, {push, 2.0}}}});
      const auto integrator = makeIntegrator(method, driven, {kTolerance, true, 1});
      integrator->advance(state, kTimeStep, kSteps);
      for (Eigen::Index i = 0; i < 4 * size; ++i) hash = hashOf(state.values().data()[i], hash);
      hash = hashOf(integrator->suppliedEnergy(), hashOf(integrator->dissipatedEnergy(), hash));
    }
  }
  return hash;
}

}  // namespace
}  // namespace spring_pendulum

int main() {
  for (const spring_pendulum::Method& method : spring_pendulum::methodTable())
    std::printf("%-20s %016llx %016llx\n", std::string(method.name).c_str(),
                static_cast<unsigned long long>(spring_pendulum::hashOfRuns(method)),
                static_cast<unsigned long long>(spring_pendulum::hashOfDrivenRuns(method)));
}

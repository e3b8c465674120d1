#include <spring_pendulum/simulation/verdict.hpp>

#include <fmt/format.h>

#include <cmath>

namespace spring_pendulum {
namespace {

/// Counted from 1; 0 if every number is finite.
Eigen::Index firstNotFinite(const State& state) {
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    if (!state.values().row(i).allFinite()) return i + 1;
  }
  return 0;
}

/// The fastest by kinetic energy, where a divergence shows first; counted from 1.
Eigen::Index mostEnergetic(const Chain& chain, const State& state) {
  Eigen::Index most = 0;
  double most_energy = -1.0;
  for (Eigen::Index i = 1; i < state.size(); ++i) {
    const double energy = chain.masses()[i] * state.velocities().row(i).squaredNorm();
    if (!(energy > most_energy)) continue;
    most_energy = energy;
    most = i;
  }
  return most + 1;
}

Verdict diverged(const Chain& chain, const State& state, const EnergyEntry& entry) {
  Verdict verdict{VerdictKind::kDiverged, entry.time, firstNotFinite(state), {}};
  if (verdict.particle > 0) {
    verdict.text = fmt::format("diverged at t = {:.6g} s: particle {} is no longer a finite number",
                               verdict.time, verdict.particle);
    return verdict;
  }
  verdict.particle = mostEnergetic(chain, state);
  verdict.text = fmt::format(
      "diverged at t = {:.6g} s: energy up by {:.3g} J, {:.3g} times the energy scale, most of it "
      "in particle {}",
      verdict.time, entry.gain, entry.relative_gain, verdict.particle);
  return verdict;
}

Verdict gainedEnergy(const EnergyEntry& entry) {
  return {VerdictKind::kGainedEnergy, entry.time, 0,
          fmt::format("gained energy: {:.3g} J above the start at t = {:.6g} s, {:.3g} % of the "
                      "energy scale, in a chain that nothing drives",
                      entry.gain, entry.time, 100.0 * entry.relative_gain)};
}

Verdict drifted(const EnergyEntry& entry) {
  return {VerdictKind::kDrift, entry.time, 0,
          fmt::format("drift: the energy balance is off by {:.3g} J at t = {:.6g} s, {:.3g} % of "
                      "the energy scale",
                      *entry.residual, entry.time, 100.0 * *entry.relative_residual)};
}

}  // namespace

std::string_view toString(VerdictKind kind) {
  switch (kind) {
    case VerdictKind::kOk:
      return "ok";
    case VerdictKind::kDrift:
      return "drift";
    case VerdictKind::kGainedEnergy:
      return "gained energy";
    case VerdictKind::kDiverged:
      return "diverged";
  }
  return "unknown";
}

Judge::Judge(const Chain& chain, const State& start, bool tracks_dissipation)
    : chain_(chain), energy_balance_(chain, start, tracks_dissipation) {}

const Verdict& Judge::judge(double time, const State& state, double dissipated) {
  entry_ = energy_balance_.entry(time, state, dissipated);
  // A state with a number that is not finite has no finite energy, so one test covers both.
  if (!(entry_.relative_gain <= kDivergenceThreshold)) {
    latest_ = diverged(chain_, state, entry_);
  } else if (entry_.relative_gain > kGainThreshold) {
    latest_ = gainedEnergy(entry_);
  } else if (entry_.relative_residual &&
             !(std::abs(*entry_.relative_residual) <= kDriftThreshold)) {
    latest_ = drifted(entry_);
  } else {
    latest_ = Verdict{};
    latest_.time = time;
  }
  if (latest_.kind > worst_.kind || worst_.kind == VerdictKind::kOk) worst_ = latest_;
  return latest_;
}

}  // namespace spring_pendulum

#include <spring_pendulum/simulation/verdict.hpp>

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Returns the first particle that is not finite, counted from 1; 0 if all are finite.
Eigen::Index firstNotFinite(const State& state) {
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    if (!state.values().row(i).allFinite()) return i + 1;
  }
  return 0;
}

/// Returns the particle with the most kinetic energy, where a divergence shows first; counted
/// from 1.
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
                      "energy scale, although no force drives the chain",
                      entry.gain, entry.time, 100.0 * entry.relative_gain)};
}

Verdict drifted(const EnergyEntry& entry) {
  return {VerdictKind::kDrift, entry.time, 0,
          fmt::format("drift: the energy balance is off by {:.3g} J at t = {:.6g} s, {:.3g} % of "
                      "the energy scale",
                      *entry.residual, entry.time, 100.0 * *entry.relative_residual)};
}

Verdict inaccurate(double time, double error, double chain_length) {
  return {
      VerdictKind::kInaccurate, time, 0,
      fmt::format("inaccurate: position error {:.3g} m at t = {:.6g} s, {:.3g} % of the chain's "
                  "length",
                  error, time, 100.0 * error / chain_length)};
}

Verdict notMeasured(double time, const ReferenceRun* reference) {
  if (reference == nullptr) {
    return {VerdictKind::kNotChecked, time, 0, "not checked: no reference run"};
  }
  switch (reference->status()) {
    case ReferenceRun::Status::kSensitive:
      return {VerdictKind::kSensitive, time, 0,
              fmt::format("sensitive from t = {:.6g} s on: small errors grow so much that the true "
                          "positions cannot be determined",
                          time)};
    case ReferenceRun::Status::kFailed:
      return {VerdictKind::kNotChecked, time, 0,
              fmt::format("not checked from t = {:.6g} s: the reference run diverged", time)};
    default:
      return {VerdictKind::kNotChecked, time, 0,
              fmt::format("not checked from t = {:.6g} s: a reference run would cost more than the "
                          "run itself",
                          time)};
  }
}

}  // namespace

std::string_view toString(VerdictKind kind) {
  switch (kind) {
    case VerdictKind::kOk:
      return "ok";
    case VerdictKind::kNotChecked:
      return "not checked";
    case VerdictKind::kSensitive:
      return "sensitive";
    case VerdictKind::kInaccurate:
      return "inaccurate";
    case VerdictKind::kDrift:
      return "drift";
    case VerdictKind::kGainedEnergy:
      return "gained energy";
    case VerdictKind::kDiverged:
      return "diverged";
  }
  return "unknown";
}

Judge::Judge(const Chain& chain, const State& start, const JudgeOptions& options)
    : chain_(chain),
      balance_(chain, start, options.tracks_dissipation),
      chain_length_(chainLength(chain, start)),
      symplectic_step_(options.symplectic_step),
      tolerance_energy_(static_cast<double>(chain.size() - 1) * 0.5 * chain.spring().stiffness *
                        (20.0 * options.tolerance) * (20.0 * options.tolerance)) {}

const Verdict& Judge::judge(double time, const State& state, double dissipated) {
  entry_ = balance_.entry(time, state, dissipated);
  return remember(judgeEnergy(state));
}

const Verdict& Judge::judge(double time, const State& state, double dissipated,
                            const ReferenceRun* reference) {
  entry_ = balance_.entry(time, state, dissipated);
  Verdict verdict = judgeEnergy(state);
  measure(time, state, verdict.kind == VerdictKind::kDiverged ? nullptr : reference);
  if (verdict.kind == VerdictKind::kDrift && hasEnergyOf(reference))
    verdict.kind = VerdictKind::kOk;
  if (verdict.kind == VerdictKind::kOk) verdict = judgePositions(time, reference);
  return remember(std::move(verdict));
}

void Judge::measure(double time, const State& state, const ReferenceRun* reference) {
  position_error_.now = PositionError{}.now;
  if (reference == nullptr || !reference->isMeasuring()) return;
  position_error_.now = reference->errorOf(state);
  if (std::isnan(position_error_.now)) return;
  position_error_.measured_until = time;
  position_error_.uncertainty = reference->uncertainty();
  if (position_error_.now <= position_error_.largest) return;
  position_error_.largest = position_error_.now;
  position_error_.largest_time = time;
}

Verdict Judge::judgeEnergy(const State& state) {
  // The negated comparison is also true for NaN, the energy of a state that is not finite.
  double allowance =
      tolerance_energy_ > 0.0 ? tolerance_energy_ / balance_.scale(entry_.time) : 0.0;
  if (!(entry_.relative_gain <= kDivergenceThreshold + allowance)) {
    return diverged(chain_, state, entry_);
  }
  double gain = entry_.relative_gain;
  double residual = entry_.relative_residual.value_or(0.0);
  if (symplectic_step_ > 0.0) {
    // To first order, the energy error is h/2 dU/dt with the potential energy U. The mean of dU/dt
    // over a time t is at most (energy scale)/t.
    gain_sum_ += gain;
    residual_sum_ += residual;
    frames_ += 1.0;
    gain = gain_sum_ / frames_;
    residual = residual_sum_ / frames_;
    allowance += entry_.time > 0.0 ? symplectic_step_ / entry_.time : 0.0;
  }
  if (gain > kGainThreshold + allowance) return gainedEnergy(entry_);
  if (std::abs(residual) > kDriftThreshold + allowance) return drifted(entry_);
  Verdict ok;
  ok.time = entry_.time;
  return ok;
}

// In a stiff transient, the dissipated energy can be wrong although the state is right.
bool Judge::hasEnergyOf(const ReferenceRun* reference) const {
  if (reference == nullptr || !reference->isMeasuring()) return false;
  const double error = entry_.energy.total() - computeEnergy(chain_, reference->state()).total();
  return std::abs(error) <= kDriftThreshold * balance_.scale(entry_.time);
}

Verdict Judge::judgePositions(double time, const ReferenceRun* reference) const {
  if (reference == nullptr || !reference->isMeasuring()) return notMeasured(time, reference);
  if (position_error_.now > kInaccurateThreshold * chain_length_) {
    return inaccurate(time, position_error_.now, chain_length_);
  }
  Verdict ok;
  ok.time = time;
  return ok;
}

void Judge::restart() {
  gain_sum_ = residual_sum_ = frames_ = 0.0;
  entry_ = {};
  position_error_ = {};
  latest_ = worst_ = {};
}

const Verdict& Judge::remember(Verdict verdict) {
  latest_ = std::move(verdict);
  if (latest_.kind > worst_.kind || worst_.kind == VerdictKind::kOk) worst_ = latest_;
  return latest_;
}

}  // namespace spring_pendulum

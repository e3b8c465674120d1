#include "simulation/judge.hpp"

#include "base/checks.hpp"
#include "base/numbers.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

/// Position error that error-controlled methods promise not to exceed, in tolerances.
constexpr double kPromise = 10.0;
/// The least energy scale is that of all springs stretched by this share of their length.
constexpr double kLeastStretch = 1e-6;

/// Names the particle that is not finite, else the one with the most kinetic energy.
Verdict diverged(const EnergyEntry& entry, const Chain& chain, const State& state) {
  const auto verdict = [time = entry.time](Eigen::Index particle, const std::string& why) {
    return Verdict{VerdictKind::kDiverged, time, particle,
                   fmt::format("diverged at t = {:.6g} s: {}", time, why)};
  };
  for (Eigen::Index i = 0; i < state.size(); ++i)
    if (!state.values().row(i).allFinite())
      return verdict(i + 1, fmt::format("particle {} is no longer a finite number", i + 1));
  Eigen::Index moving = chain.size() - 1, most = 0;
  const auto speeds_squared = state.velocities().bottomRows(moving).rowwise().squaredNorm();
  const auto is_free = chain.inverseMasses().tail(moving).array() > 0.0;
  is_free.select(speeds_squared.cwiseProduct(chain.masses().tail(moving)), 0.0).maxCoeff(&most);
  return verdict(most + 2, fmt::format("energy up by {:.3g} J, {:.3g} times the energy scale, with "
                                       "the most kinetic energy in particle {}",
                                       entry.gain, entry.relative_gain, most + 2));
}

/// The kinetic energy of the whole chain at the speed of its fastest held particle, J.
double energyOfHolders(const Chain& chain, const State& state) {
  double fastest = 0.0;
  for (const HeldParticle& held : chain.drive().held)
    fastest = std::max(fastest, state.velocities().row(held.particle).squaredNorm());
  return fastest > 0.0 ? 0.5 * chain.masses().tail(chain.size() - 1).sum() * fastest : 0.0;
}

}  // namespace

std::string_view toString(VerdictKind kind) {
  constexpr std::string_view kNames[] = {"ok",    "not checked",   "sensitive", "inaccurate",
                                         "drift", "gained energy", "diverged"};
  return kNames[static_cast<int>(kind)];
}

Judge::Judge(const Chain& chain, const State& start, const JudgeOptions& options, double start_time)
    : chain_(chain),
      options_(options),
      start_energy_(computeEnergy(chain, start).total()),
      start_height_(start.y()[0]),
      mean_time_(start_time) {
  measureChain(start, start_energy_, start_time);
  oscillation_ = oscillationOf(start);
}

double Judge::change(const Chain& chain, const State& before, const State& after,
                     const JudgeOptions& options, double supplied, bool has_moved) {
  const double energy_before = energyOf(before).total();
  oscillation_ -= oscillationOf(before);
  if (!changed_ || options.symplectic_order != options_.symplectic_order ||
      options.symplectic_step != options_.symplectic_step ||
      !(chain.constants() == chain_.constants())) {
    mean_time_ = entry_.time;
    sums_.setZero();
  }
  options_ = options;
  if (has_moved) largest_scale_ = scale(entry_.time, supplied);
  chain_ = chain;
  changed_ = true;
  if (worst_.kind == VerdictKind::kOk)
    worst_ = {VerdictKind::kNotChecked, entry_.time, 0,
              fmt::format("not checked from t = {:.6g} s on: driven or changed", entry_.time)};
  const double energy_after = energyOf(after).total();
  oscillation_ += oscillationOf(after);
  measureChain(after, energy_after, entry_.time);
  return supplied + energy_after - energy_before;
}

void Judge::measureChain(const State& state, double energy, double time) {
  requireSize(chain_.size(), state.size());
  const SpringLaw& spring = chain_.spring();
  Eigen::ArrayXd forces = Eigen::ArrayXd::Zero(chain_.size());
  for (const auto& [i, force] : chain_.drive().forces) forces[i] += std::hypot(force.x, force.y);
  // Sums from the free end: weight and forces beyond a spring, -E_min, and springs hardly stretched.
  double weight = 0.0, pull = 0.0, depth = 0.0, least = 0.0;
  pulled_depth_ = 0.0;
  for (Eigen::Index i = chain_.size() - 1; i > 0; --i) {
    weight += chain_.masses()[i] * std::abs(chain_.gravity());
    pull += forces[i];
    depth += weight * spring.rest_length;
    pulled_depth_ += pull * spring.rest_length;
    if (spring.stiffness > 0.0) {
      depth += 0.5 * weight * weight / spring.stiffness;
      pulled_depth_ += pull * (weight + 0.5 * pull) / spring.stiffness;
    }
    const double stretch = kLeastStretch * std::max(spring.rest_length, springLength(state, i - 1));
    least += 0.5 * spring.stiffness * stretch * stretch;
  }
  still_scale_ = std::max(std::max(start_energy_, 0.0) + depth, least);
  const double fall = spring.stiffness == 0.0 ? 0.5 * weight * std::abs(chain_.gravity()) : 0.0;
  if (std::exchange(fall_, fall) != fall) fall_time_ = time;
  for (const double number : {energy, still_scale_, pulled_depth_, fall_})
    if (!std::isfinite(number))
      throw InputError(
          "the initial energy exceeds the range of a double: masses, lengths, speeds, stiffness or "
          "gravity must be smaller");
}

Energy Judge::energyOf(const State& state) const {
  Energy energy = computeEnergy(chain_, state);
  const double raised = state.y()[0] - start_height_;
  if (raised == 0.0) return energy;
  for (Eigen::Index i = 1; i < chain_.size(); ++i)
    if (!chain_.isHeld(i)) energy.gravity += chain_.masses()[i] * chain_.gravity() * raised;
  return energy;
}

double Judge::scale(double time, double supplied) const {
  const double t = time - fall_time_, now = still_scale_ + fall_ * t * t + std::abs(supplied);
  return std::max({largest_scale_, now, std::numeric_limits<double>::min()});
}

EnergyEntry Judge::balanceOf(double time, const State& state, double dissipated,
                             double supplied) const {
  EnergyEntry entry;
  entry.time = time;
  entry.energy = energyOf(state);
  entry.supplied = supplied;
  entry.gain = entry.energy.total() - start_energy_ - supplied;
  // A drive that has just begun has supplied less energy than it is going to.
  entry.scale = std::max(scale(time, supplied) + pulled_depth_, energyOfHolders(chain_, state));
  entry.relative_gain = entry.gain / entry.scale;
  if (options_.track_dissipation) entry.dissipated = dissipated;
  if (!chain_.isDissipative() && !changed_) entry.dissipated = 0.0;
  if (entry.dissipated) {
    entry.residual = entry.gain + *entry.dissipated;
    entry.relative_residual = *entry.residual / entry.scale;
  }
  return entry;
}

const Verdict& Judge::judge(double time, const State& state, double dissipated,
                            const ReferenceRun* reference, double supplied) {
  const bool is_measuring = reference != nullptr && reference->isMeasuring();
  entry_ = balanceOf(time, state, dissipated, supplied);
  if (is_measuring && entry_.residual && chain_.isDissipative()) {
    const double right = energyOf(*reference->state()).total();
    dissipated_error_ = *entry_.residual - (entry_.energy.total() - right);
  }
  Verdict verdict = energyVerdict(time, state, supplied, is_measuring);
  measure(state, is_measuring && verdict.kind != VerdictKind::kDiverged ? reference : nullptr);
  const bool has_news = is_measuring || worst_.kind == VerdictKind::kOk;  // an end is said once
  if (verdict.kind == VerdictKind::kOk && has_news) verdict = positionVerdict(reference);
  latest_ = std::move(verdict);
  if (latest_.kind > worst_.kind || worst_.kind == VerdictKind::kOk) worst_ = latest_;
  return latest_;
}

void Judge::measure(const State& state, const ReferenceRun* reference) {
  PositionError& error = position_error_;
  error.now = error.uncertainty = PositionError{}.now;
  const bool only_start = error.largest == 0.0 && error.measured_until == error.largest_time;
  if (reference == nullptr && only_start) error = {};
  if (reference == nullptr) return;
  error.now = reference->errorOf(state);
  error.uncertainty = reference->uncertainty();
  error.measured_until = entry_.time;
  error.bound = std::fmax(error.bound, error.now + error.uncertainty);
  const double promise = kPromise * options_.tolerance;
  const bool unknown = error.uncertainty > promise;
  if (promise > 0.0 && sensitive_.empty() && (unknown || !(error.now <= promise))) {
    if (unknown || reference->isSensitive())
      sensitive_ = fmt::format(
          "sensitive from t = {:.6g} s on: small errors grow so much that no method can promise a "
          "tolerance of {:.3g} m",
          entry_.time, options_.tolerance);
    else if (exceeded_.empty())
      exceeded_ = fmt::format(
          "the position error exceeds ten times the tolerance from t = {:.6g} s on", entry_.time);
  }
  if (error.now <= error.largest) return;
  error.largest = error.now;
  error.largest_time = entry_.time;
}

Eigen::Array2d Judge::oscillationOf(const State& state) const {
  const double h = options_.symplectic_step, k = chain_.spring().stiffness;
  if (options_.symplectic_order == 0) return {0.0, 0.0};
  Eigen::ArrayX2d forces = Eigen::ArrayX2d::Zero(state.size(), 2);
  double second = 0.0;  // f²/m + v·K v, with f of all forces
  for (Eigen::Index i = 0; i + 1 < state.size(); ++i) {
    if (chain_.isHeld(i) && chain_.isHeld(i + 1)) continue;  // it has no energy, see computeEnergy
    const Eigen::RowVector4d z = state.values().row(i + 1) - state.values().row(i);
    const PlaneVector<double> d{z[0], z[1]}, v{z[2], z[3]};
    const double inverse = inverseLength(d), rate = elongationRate(d, v), speed = lengthOf(v);
    const auto [x, y] = undampedSpringForce(chain_.spring(), d, inverse);
    // Without this limit, particles that pass each other within a step would count without bound.
    const double turning = k * chain_.spring().rest_length * std::min(inverse, 1.0 / (h * speed));
    forces.row(i) += Eigen::Array2d(x, y).transpose();
    forces.row(i + 1) -= Eigen::Array2d(x, y).transpose();
    second += (k - turning) * speed * speed + turning * rate * rate;
  }
  double work = 0.0;  // of the trapezoidal rule for the work of accelerated holders
  for (const auto& [i, a] : chain_.drive().held) work += a.x * forces(i, 0) + a.y * forces(i, 1);
  const Eigen::ArrayXd inverse = chain_.inverseMasses();
  forces.col(1) -= (inverse > 0.0).select(chain_.gravity() * chain_.masses().array(), 0.0);
  double first = 0.125 * (forces.square().rowwise().sum() * inverse).sum() * h * h;
  if (options_.symplectic_order == 1) {
    const auto power = forces * state.velocities().array();
    first = -0.5 * h * (inverse > 0.0).select(power.rowwise().sum(), 0.0).sum();
  }
  for (const auto& [i, force] : chain_.drive().forces)
    forces.row(i) += Eigen::Array2d(force.x, force.y).transpose();
  second += 2.0 * work + (forces.square().rowwise().sum() * inverse).sum();
  first += 0.25 * h * h * work;
  return {first, first - h * h / 12.0 * second};
}

Verdict Judge::energyVerdict(double time, const State& state, double supplied, bool is_measuring) {
  largest_scale_ = scale(time, supplied);
  const double spread = std::min(2.0 * kPromise * options_.tolerance, 1e150);  // m, squared below
  double allowance = static_cast<double>(chain_.size() - 1) * 0.5 * chain_.spring().stiffness *
                     spread * spread / largest_scale_;
  const double residual = entry_.relative_residual.value_or(0.0);
  worst_residual_ = std::fmax(worst_residual_, std::abs(residual));
  // Negated comparisons are also true for NaN, the energy of a state that is not finite.
  if (!(entry_.relative_gain <= kDivergenceThreshold + allowance))
    return diverged(entry_, chain_, state);
  // In a stiff transient, the dissipated energy can be wrong although the state is right.
  const double wrong = residual != 0.0 ? dissipated_error_ / *entry_.residual : 0.0;
  decltype(sums_) errors;
  errors << entry_.relative_gain, residual, (1.0 - wrong) * residual,
      (oscillationOf(state) - oscillation_) / entry_.scale, 1.0;
  if (options_.symplectic_step > 0.0 && time > mean_time_) {
    allowance += options_.symplectic_step / (time - mean_time_);
    sums_ += errors;
    errors = sums_ / sums_[5];
  }
  // Of the errors of the energy and of two modified ones, the least counts, also after a change of the method.
  const Eigen::Array3d shifts(0.0, errors[3], errors[4]);
  const auto amount = [&](double joules, double share, std::string_view what) {
    if (options_.symplectic_step > 0.0)
      return fmt::format("{:.3g} % of the scale{} on average until t = {:.6g} s", 100.0 * share,
                         what, time);
    return fmt::format("{:.3g} J{} at t = {:.6g} s, {:.3g} % of the energy scale", joules, what,
                       time, 100.0 * share);
  };
  if ((errors[0] - shifts).minCoeff() > kGainThreshold + allowance)
    return {
        VerdictKind::kGainedEnergy, time, 0,
        fmt::format("gained energy: {}, although {}",
                    amount(entry_.gain, errors[0], " above the start"),
                    changed_ || chain_.isDriven() ? "the energy supplied to the chain is counted"
                                                  : "no force drives the chain")};
  const double drift =
      std::min((errors[1] - shifts).abs().minCoeff(), (errors[2] - shifts).abs().minCoeff());
  // The energy that symplectic methods dissipate has errors of its own, known from the reference run only.
  const bool is_known = is_measuring || options_.symplectic_step == 0.0 || !chain_.isDissipative();
  if (entry_.residual && is_known && !(drift <= kDriftThreshold + allowance))
    return {VerdictKind::kDrift, time, 0,
            "drift: the energy balance is off by " + amount(*entry_.residual, errors[1], "")};
  return {VerdictKind::kOk, time, 0, "ok"};
}

Verdict Judge::positionVerdict(const ReferenceRun* reference) const {
  const double time = entry_.time;
  if (reference == nullptr)
    return {VerdictKind::kNotChecked, time, 0, "not checked: no reference run"};
  if (!reference->isMeasuring())
    return {reference->verdict(), time, 0,
            fmt::format("{} from t = {:.6g} s on: {}", toString(reference->verdict()), time,
                        reference->reason())};
  const double error = position_error_.now, length = reference->length();
  if (error <= kInaccurateThreshold * length) return {VerdictKind::kOk, time, 0, "ok"};
  return {
      VerdictKind::kInaccurate, time, 0,
      fmt::format("inaccurate: position error {:.3g} m at t = {:.6g} s, {:.3g} % of the chain's "
                  "length",
                  error, time, 100.0 * error / length)};
}

bool Judge::isShown(bool continues_after_divergence) const {
  return latest_.kind != VerdictKind::kDiverged ||
         (continues_after_divergence && std::isfinite(entry_.energy.total()));
}

std::string Judge::measurements() const {
  const PositionError& error = position_error_;
  std::string text = "position error not measured";
  if (!std::isnan(error.measured_until)) {
    text = error.isResolved() ? fmt::format("largest position error {} m at t = {:.6g} s",
                                            roundedText(error.largest, 2), error.largest_time)
                              : fmt::format("largest position error below {} m",
                                            roundedText(1.05 * error.bound, 2));
    if (error.measured_until < entry_.time)
      text += fmt::format(" (measured until t = {:.6g} s)", error.measured_until);
  }
  return text + (entry_.relative_residual
                     ? fmt::format(", largest energy error {} times the energy scale",
                                   roundedText(worst_residual_, 2))
                     : ", energy balance not checked");
}

std::string Judge::toleranceRemark() const {
  return exceeded_ + (exceeded_.empty() || sensitive_.empty() ? "" : "; ") + sensitive_;
}

}  // namespace spring_pendulum

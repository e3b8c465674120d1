#include "ros/inputs/driver.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

using Vector = Eigen::Vector2d;

constexpr double kSettled = 1e-9;  // m and m/s: a held particle nearer to its target is at rest
/// Constants that change while the chain moves.
const std::vector<std::string> kLive = {"tolerance",   "stiffness", "damping",
                                        "rest_length", "gravity",   "air_drag"};
/// Largest constant of a running chain, SI units. After larger ones, it overflows or takes hours per frame.
constexpr double kLargest = 1e9;
constexpr double kLargestAcceleration = 1e6;  // by a force, chain lengths per s²
constexpr std::size_t kMostForces = 1000;
constexpr double kLengthsPerSecond = 5.0;  // largest speed towards a target, in chain lengths

/// Returns all numbers of a drive.
std::vector<double> numbersOf(const Drive& drive) {
  std::vector<double> numbers{static_cast<double>(drive.held.size())};
  const auto add = [&](std::ptrdiff_t particle, const PlaneVector<double>& vector) {
    numbers.insert(numbers.end(), {static_cast<double>(particle), vector.x, vector.y});
  };
  for (const auto& [particle, acceleration] : drive.held) add(particle, acceleration);
  for (const auto& [particle, force] : drive.forces) add(particle, force);
  return numbers;
}

/// Whether the run has this method, its tolerance and these constants.
bool isSame(const Scenario& wanted, const Run& run) {
  const Method& method = run.plan().method;
  return &wanted.method.get() == &method && wanted.constants == run.chain().constants() &&
         (method.hasFixedStep() || wanted.tolerance == run.plan().tolerance);
}

}  // namespace

Driver::Driver(const Run& run, InputLog* log, double settling)
    : run_(run),
      log_(log),
      settling_(settling),
      fastest_(kLengthsPerSecond * std::max(chainLength(run.chain(), run.start()), 1.0)),
      wanted_{run.plan(), run.chain().constants()} {}

std::string Driver::on(const SetConstant& request) {
  const std::string& name = request.name;
  if (name != "method" && std::find(kLive.begin(), kLive.end(), name) == kLive.end())
    throw InputError(unknownName("live constant", name, kLive));
  Scenario wanted = wanted_;
  OptionSet all(scenarioOptions(wanted));
  const Option& option = all.find(name, "set");
  all.set(option, request.value, name);
  checkScenario(wanted);
  const auto& [spring, gravity, air_drag] = wanted.constants;
  const double largest =
      std::max({spring.stiffness, spring.damping, spring.rest_length, std::abs(gravity), air_drag});
  if (largest > kLargest)
    throw InputError(fmt::format("{}: must be at most {:g} while the chain moves", name, kLargest));
  if (!wanted.method.get().hasFixedStep())
    checkTolerance(wanted.tolerance, Chain(run_.chain().masses(), wanted.constants),
                   run_.isOver() ? run_.start() : run_.state());
  wanted_ = wanted;
  return fmt::format("{} is {} from the next state on{}", name, option.text(),
                     name == "method" ? ", or from the next frame on" : "");
}

std::string Driver::on(const ApplyForceTo& request) {
  const auto& [particle, force, start_time, duration] = request;
  if (run_.isOver()) throw InputError("the run is over; call ~reset to start it again");
  const Chain& chain = run_.chain();
  Drive drive{{}, {{particle, force}}};
  for (const auto& [i, target] : targets_) drive.held.push_back({i, {}});
  static_cast<void>(chain.drivenBy(drive));  // refuses a force that the chain cannot have
  if (!std::isfinite(start_time) || !std::isfinite(duration))
    throw InputError("start_time and duration must be finite");
  const double strongest = kLargestAcceleration * chain.masses()[particle] *
                           std::max(chainLength(chain, run_.start()), 1.0);
  if (!(std::hypot(force.x, force.y) <= strongest))
    throw InputError(
        fmt::format("force must be at most {:.3g} N on particle {}", strongest, particle + 1));
  if (forces_.size() >= kMostForces)
    throw InputError("too many forces act already; call ~clear_forces");
  const double begin = std::max(start_time, run_.time());
  const double lasts = duration < 0.0 ? std::numeric_limits<double>::infinity() : duration;
  forces_.push_back({particle, force, begin, lasts});
  return fmt::format(
      "particle {}: ({:.6g}, {:.6g}) N from t = {:.6g} s {}", particle + 1, force.x, force.y, begin,
      std::isinf(lasts) ? "until clear_forces" : fmt::format("to {:.6g} s", begin + lasts));
}

std::string Driver::on(const ClearForces& /*request*/) {
  const std::size_t count = std::exchange(forces_, {}).size();
  return counted(static_cast<std::int64_t>(count), "force") + " cleared";
}

std::string Driver::on(const ComeToRest& /*request*/) {
  if (run_.isOver()) throw InputError("the run is over; call ~reset to start it again");
  const Chain wanted = Chain(run_.chain().masses(), wanted_.constants);
  State state = run_.state();
  Drive drive = driveUntil(run_.nextTime(), state);  // that of the run may be out of date
  drive.forces.clear();
  bool lasts = true;
  for (const ApplyForceTo& force : forces_) {
    if (!isHeld(force.particle) && force.start_time <= run_.time() &&
        force.start_time + force.duration >= run_.nextTime())
      drive.forces.push_back({force.particle, force.force});
    lasts = lasts && force.start_time <= run_.time() && std::isinf(force.duration);
  }
  jump_ = std::make_unique<State>(equilibrium(wanted.drivenBy(drive), state));
  return std::string("the chain hangs at rest from the next state on") +
         (lasts ? "" : ", until a force begins or ends");
}

std::string Driver::on(const Hold& request) {
  const std::ptrdiff_t i = request.particle;
  targets_[i] = request.target.value_or(Target{{run_.state().x()[i], run_.state().y()[i]}, {}, {}});
  return fmt::format("particle {} is held", i + 1);
}

std::string Driver::on(const Release& request) {
  if (targets_.erase(request.particle) > 0 && request.particle == 0) on(Hold{0, {}});
  return fmt::format("particle {} is released", request.particle + 1);
}

Drive Driver::driveUntil(double next_time, State& state) {
  Drive drive;
  const double interval = std::max(next_time - run_.time(), 1e-6);
  const double settling = std::max(interval, settling_);
  // With these gains, both eigenvalues of the distance and the velocity are at 1 - interval / settling.
  const double pull = 1.0 / (settling * settling);
  const double brake = (2.0 - 0.5 * interval / settling) / settling;
  for (const auto& [i, target] : targets_) {
    const Vector x(state.x()[i] - target.position.x, state.y()[i] - target.position.y);
    const Vector v(state.vx()[i] - target.velocity.x, state.vy()[i] - target.velocity.y);
    HeldParticle held{i, {}};
    if (!x.isZero(kSettled) || !v.isZero(kSettled)) {
      const double fastest = target.fastest > 0.0 ? target.fastest : fastest_;
      const double share = std::min(1.0, fastest * brake / pull / x.norm());
      const Vector next = v - interval * (share * pull * x + brake * v);
      const double most = std::max(fastest, (1.0 - interval / settling) * v.norm());
      const Vector a = (std::min(1.0, most / next.norm()) * next - v) / interval;
      held.acceleration = {target.acceleration.x + a.x(), target.acceleration.y + a.y()};
    } else if (target.velocity.x == 0.0 && target.velocity.y == 0.0) {
      state.vx()[i] = state.vy()[i] = 0.0;
    }
    drive.held.push_back(held);
  }
  const double now = run_.time();
  const auto end_of = [](const ApplyForceTo& force) { return force.start_time + force.duration; };
  forces_.erase(std::remove_if(forces_.begin(), forces_.end(),
                               [&](const ApplyForceTo& f) { return end_of(f) <= now; }),
                forces_.end());
  for (const ApplyForceTo& force : forces_) {
    if (isHeld(force.particle) || force.start_time >= next_time) continue;
    // The impulse of the part of the interval in which the force acts.
    const double acts = std::min(end_of(force), next_time) - std::max(force.start_time, now);
    const double share = acts < next_time - now ? acts / (next_time - now) : 1.0;
    drive.forces.push_back({force.particle, {share * force.force.x, share * force.force.y}});
  }
  return drive;
}

void Driver::apply(Run& run, double next_time, bool paused) {
  if (run.isOver()) return;
  // Most runs are left alone: for them, no state is copied.
  if (!isActing() && !jump_ && !run.chain().isDriven() && isSame(wanted_, run)) return;
  State state = jump_ ? *jump_ : run.state();
  Drive drive = paused ? Drive{} : driveUntil(next_time, state);
  for (const auto& [i, target] : targets_) {
    if (!paused) break;
    state.values().row(i) << target.position.x, target.position.y, 0.0, 0.0;
    drive.held.push_back({i, {}});
  }
  jump_.reset();
  if (numbersOf(drive) == std::vector{1.0, 0.0, 0.0, 0.0} && state.velocities().row(0).isZero(0.0))
    drive = {};  // an anchor at rest needs no drive
  Scenario scenario = wanted_;
  const Method& method = run.plan().method;
  if (wanted_.method.get().hasFixedStep() != method.hasFixedStep() && !run.isAtFrame())
    scenario.method = method;  // fixed steps and error control alternate at frames only
  const bool same = numbersOf(drive) == numbersOf(run.chain().drive()) && isSame(scenario, run) &&
                    state.values() == run.state().values();
  if (same) return;
  try {
    const State before = run.state();
    const double time = run.time();
    run.change(scenario, scenario.constants, drive, state);
    if (log_ != nullptr) log_->changed(run, before, time);
  } catch (...) {
    wanted_ = {run.plan(), run.chain().constants()};
    forces_.clear();
    throw;
  }
}

void Driver::reset(Run& run, const Scene* to) {
  const double time = run.time();
  const State& state = to != nullptr ? to->state : run.start();
  targets_.clear();
  forces_.clear();
  jump_.reset();
  if (run.isChanged() || !isSame(wanted_, run)) {
    run.reset();  // methods may change at a frame only
    try {
      run.change(wanted_, wanted_.constants, {}, state);
    } catch (const InputError&) {  // what was wanted for another state is impossible at the start
      wanted_ = {run.plan(), run.chain().constants()};
      run.change(wanted_, wanted_.constants, {}, state);
    }
  }
  run.goTo(to != nullptr ? to->frame : run.firstFrame(), state);
  if (log_ != nullptr) log_->started(run, time);
}

}  // namespace spring_pendulum

#include "ros/inputs/holders.hpp"

#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

/// A held particle nearer to its target than this, m and m/s, is at rest.
constexpr double kSettled = 1e-9;
constexpr std::size_t kMostForces = 1000;
/// Largest speed of a particle on the way to its target, in lengths of the chain per second.
constexpr double kLengthsPerSecond = 5.0;

bool isSame(const Drive& a, const Drive& b) {
  const auto same_vector = [](const PlaneVector<double>& p, const PlaneVector<double>& q) {
    return p.x == q.x && p.y == q.y;
  };
  return std::equal(a.held.begin(), a.held.end(), b.held.begin(), b.held.end(),
                    [&](const HeldParticle& p, const HeldParticle& q) {
                      return p.particle == q.particle &&
                             same_vector(p.acceleration, q.acceleration);
                    }) &&
         std::equal(a.forces.begin(), a.forces.end(), b.forces.begin(), b.forces.end(),
                    [&](const AppliedForce& p, const AppliedForce& q) {
                      return p.particle == q.particle && same_vector(p.force, q.force);
                    });
}

bool isSame(const Scenario& a, const Scenario& b) {
  return &a.method.get() == &b.method.get() && a.stiffness == b.stiffness &&
         a.damping == b.damping && a.rest_length == b.rest_length && a.gravity == b.gravity &&
         a.air_drag == b.air_drag && a.tolerance == b.tolerance;
}

}  // namespace

Holders::Holders(const Run& run, InputLog* log)
    : run_(run),
      log_(log),
      fastest_(kLengthsPerSecond * std::max(chainLength(run.chain(), run.start()), 1.0)),
      wanted_(run.scenario()) {}

void Holders::hold(std::ptrdiff_t particle) {
  hold(particle, {{run_.state().x()[particle], run_.state().y()[particle]}, {}});
}

void Holders::release(std::ptrdiff_t particle) {
  if (targets_.erase(particle) > 0 && particle == 0) hold(0);
}

bool Holders::push(const TimedForce& force) {
  if (forces_.size() >= kMostForces) return false;
  forces_.push_back(force);
  return true;
}

std::size_t Holders::clearForces() {
  const std::size_t count = forces_.size();
  forces_.clear();
  return count;
}

Drive Holders::driveUntil(double next_time, State& state) {
  Drive drive;
  const double interval = std::max(next_time - run_.time(), 1e-6);
  for (const auto& [i, target] : targets_) {
    const double x = state.x()[i] - target.position.x, y = state.y()[i] - target.position.y;
    const double vx = state.vx()[i] - target.velocity.x, vy = state.vy()[i] - target.velocity.y;
    HeldParticle held{i, {}};
    if (std::max({std::abs(x), std::abs(y), std::abs(vx), std::abs(vy)}) > kSettled) {
      // The double integrator with these gains has both eigenvalues at 0.
      const double distance = std::sqrt(x * x + y * y);
      const double longest = 1.5 * fastest_ * interval;
      const double share = distance > longest ? longest / distance : 1.0;
      held.acceleration = {target.acceleration.x - (share * x / interval + 1.5 * vx) / interval,
                           target.acceleration.y - (share * y / interval + 1.5 * vy) / interval};
    } else if (target.velocity.x == 0.0 && target.velocity.y == 0.0) {
      state.vx()[i] = state.vy()[i] = 0.0;
    }
    drive.held.push_back(held);
  }
  const double now = run_.time();
  forces_.erase(std::remove_if(forces_.begin(), forces_.end(),
                               [&](const TimedForce& force) { return force.end <= now; }),
                forces_.end());
  for (const TimedForce& force : forces_) {
    if (isHeld(force.particle) || force.begin >= next_time) continue;
    // The impulse of the part of the interval in which the force acts.
    const double share = (std::min(force.end, next_time) - std::max(force.begin, now)) / interval;
    drive.forces.push_back({force.particle, {share * force.force.x, share * force.force.y}});
  }
  return drive;
}

Scenario Holders::possible() const {
  Scenario scenario = wanted_;
  const Method& method = run_.scenario().method;
  if (wanted_.method.get().hasFixedStep() != method.hasFixedStep() && !run_.isAtFrame()) {
    scenario.method = method;
  }
  return scenario;
}

void Holders::apply(Run& run, std::unique_ptr<Integrator>& integrator, double next_time,
                    bool paused) {
  if (run.isOver()) return;
  // Most runs are left alone: for them, no state is copied.
  if (targets_.empty() && forces_.empty() && !jump_ && !run.chain().isDriven() &&
      isSame(wanted_, run.scenario())) {
    return;
  }
  State state = jump_ ? *jump_ : run.state();
  Drive drive;
  if (paused) {
    for (const auto& [i, target] : targets_) {
      state.values().row(i) << target.position.x, target.position.y, 0.0, 0.0;
      drive.held.push_back({i, {}});
    }
  } else {
    drive = driveUntil(next_time, state);
  }
  jump_.reset();
  // An anchor at rest needs no drive.
  if (drive.held.size() == 1 && drive.held[0].particle == 0 && drive.forces.empty() &&
      drive.held[0].acceleration.x == 0.0 && drive.held[0].acceleration.y == 0.0 &&
      state.vx()[0] == 0.0 && state.vy()[0] == 0.0) {
    drive = {};
  }
  const Scenario scenario = possible();
  const bool same = isSame(drive, run.chain().drive()) && isSame(scenario, run.scenario()) &&
                    state.values() == run.state().values();
  if (same) return;
  try {
    const State before = run.state();
    run.change(scenario, drive, state, integrator);
    if (log_ != nullptr) log_->changed(run, before);
  } catch (...) {
    wanted_ = run.scenario();
    forces_.clear();
    throw;
  }
}

void Holders::reset(Run& run, std::unique_ptr<Integrator>& integrator, const Particles* to) {
  const double time = run.time();
  const State& state = to != nullptr ? to->state : run.start();
  targets_.clear();
  forces_.clear();
  jump_.reset();
  if (run.isChanged()) {
    try {
      run.change(possible(), {}, state, integrator);
    } catch (const InputError&) {  // what was wanted for another state is impossible at the start
      wanted_ = run.scenario();
      run.change(wanted_, {}, state, integrator);
    }
  }
  if (to != nullptr) {
    run.goTo(to->frame, to->state, *integrator);
  } else {
    run.reset(*integrator);
  }
  if (log_ != nullptr) log_->started(run, time);
}

}  // namespace spring_pendulum

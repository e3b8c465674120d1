#include "integration/implicit/radau_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

using radau::kStages;

/// Largest estimated error per second, in tolerances.
constexpr double kShareOfTolerance = 0.3;
/// Factor of the first step size, which is short for any scene.
constexpr double kFirstStep = 1e-4;
/// The error of a step is O(h^kErrorOrder).
constexpr int kErrorOrder = static_cast<int>(kStages) + 1;
/// The stage nearest to the middle of the step, at which springs are linearised.
constexpr std::size_t kMiddleStage = 2;
/// Largest error of the iteration, relative to the allowed error of the step.
constexpr double kIterationShare = 1e-3;
constexpr int kMostIterations = 10;
/// Size of rounding errors of the positions, m.
constexpr double kRounding = 1e-14;
/// Error, relative to the allowed error, that a failed iteration reports; it halves the step size.
constexpr double kErrorOfFailure = 32.0;
/// Step size in s up to which an explicit step may take the place of a failed iteration.
constexpr double kLongestExplicit = 1e-10;

/// Component c of the state of a particle: x, y, vx, vy.
template <typename Buffer>
auto& valueOf(Buffer& state, std::size_t particle, std::size_t c) {
  auto* const row = state.particle(static_cast<Eigen::Index>(particle));
  return row[static_cast<Eigen::Index>(c) * state.pitch()];
}

std::array<double, 2> springlessAcceleration(const Chain& chain, std::size_t particle) {
  const auto [x, y] = chain.springlessAcceleration(static_cast<Eigen::Index>(particle));
  return {x, y};
}

}  // namespace

RadauStepper::RadauStepper(const Chain& chain, double tolerance, const ChainKernels& kernels)
    : ErrorEstimatingStepper(chain, kShareOfTolerance * tolerance, static_cast<int>(kStages),
                             kernels,
                             kFirstStep * root(kShareOfTolerance * tolerance, kErrorOrder)),
      allowed_rate_(kShareOfTolerance * tolerance),
      stages_(chain.size()),
      previous_(chain.size()),
      springs_(static_cast<std::size_t>(chain.size() - 1)),
      real_(chain_, radau::kReal),
      pairs_{{{chain_, radau::kPairs[0]}, {chain_, radau::kPairs[1]}}},
      change_(chain.size()) {}

void RadauStepper::prepare(bool restarted) {
  std::swap(stages_, previous_);
  previous_length_ = restarted ? 0.0 : statistics_.last_step;
}

double RadauStepper::attempt(double h) {
  if (h <= kShortestStep) return stepExplicitly(h);
  predict(h);
  linearise();
  real_.factor(springs_, h);
  for (System<Complex>& pair : pairs_) pair.factor(springs_, h);
  if (!solveStages(h)) {
    if (h > kLongestExplicit) return kErrorOfFailure * allowed_rate_;
    // Near a collision. The error of the positions per time is half of the change of the velocities.
    return stepExplicitly(h) + 0.5 * change_.values().rightCols<2>().cwiseAbs().maxCoeff();
  }
  const double error = estimateError(h);
  setEndFromLastStage();
  return error / h;
}

RadauStepper::Ends RadauStepper::endsOf(std::size_t spring, const StateBuffer& state) {
  const std::ptrdiff_t pitch = state.pitch();
  const double* z = state.particle(static_cast<Eigen::Index>(spring));
  return {{z[1] - z[0], z[pitch + 1] - z[pitch]},
          {z[2 * pitch + 1] - z[2 * pitch], z[3 * pitch + 1] - z[3 * pitch]}};
}

RadauStepper::Ends RadauStepper::endsOf(std::size_t spring, const Ends& start,
                                        std::size_t stage) const {
  const Increments& a = stages_.particles[spring];
  const Increments& b = stages_.particles[spring + 1];
  const auto change = [&](std::size_t c) { return b[c][stage] - a[c][stage]; };
  return {{start.separation.x + change(0), start.separation.y + change(1)},
          {start.relative_velocity.x + change(2), start.relative_velocity.y + change(3)}};
}

void RadauStepper::predict(double h) {
  const double ratio = previous_length_ > 0.0 ? h / previous_length_ : 0.0;
  std::array<Row, kStages> weights{}, tension_weights{};
  for (std::size_t s = 0; s < kStages; ++s) {
    weights[s] = radau::lagrangeWeights(1.0 + ratio * radau::kNodes[s], true);
    tension_weights[s] = radau::lagrangeWeights(1.0 + ratio * radau::kNodes[s], false);
  }
  const auto guess = [&](double velocity, const Row& old, Row& position, Row& change) {
    for (std::size_t s = 0; s < kStages; ++s) change[s] = radau::dot(weights[s], old) - old.back();
    for (std::size_t s = 0; s < kStages; ++s)
      position[s] = h * (radau::kNodes[s] * velocity + radau::dot(radau::kMatrix[s], change));
  };
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    const Increments& old = previous_.particles[i];
    Increments& next = stages_.particles[i];
    // At the start, two particles in one place thus part in the right direction.
    if (previous_length_ == 0.0 || (i == 0 && chain_.isDriven()))
      moveWithoutSprings(i, h);
    else
      for (std::size_t c = 0; c < 2; ++c)
        guess(valueOf(begin_, i, 2 + c), old[2 + c], next[c], next[2 + c]);
  }
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    Row& tensions = stages_.tensions[i];
    tensions.fill(tensionOf(endsOf(i, begin_)));
    if (previous_length_ == 0.0) continue;
    for (std::size_t s = 0; s < kStages; ++s)
      tensions[s] = radau::dot(tension_weights[s], previous_.tensions[i]);
  }
}

void RadauStepper::moveWithoutSprings(std::size_t particle, double h) {
  const auto acceleration = springlessAcceleration(chain_, particle);
  const double rate = dragOn(particle) / massOf(chain_, static_cast<Eigen::Index>(particle));
  Increments& stage = stages_.particles[particle];
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t s = 0; s < kStages; ++s) {
      const double time = h * radau::kNodes[s];
      stage[2 + c][s] = time * acceleration[c] / (1.0 + time * rate);
      stage[c][s] = time * (valueOf(begin_, particle, 2 + c) + 0.5 * stage[2 + c][s]);
    }
}

void RadauStepper::linearise() {
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Ends middle = endsOf(i, endsOf(i, begin_), kMiddleStage);
    springs_[i] = linearSpring(chain_.spring(), middle.separation, middle.relative_velocity,
                               stages_.tensions[i][kMiddleStage]);
  }
}

bool RadauStepper::solveStages(double h) {
  const double wanted = kIterationShare * allowed_rate_ * h;
  double last = 0.0;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    computeResiduals();
    real_.solve();
    for (System<Complex>& pair : pairs_) pair.solve();
    const LargestChange change = updateStages();
    // std::max may drop a NaN; the second term keeps it.
    const double size =
        std::max(change.position, change.velocity) + 0.0 * (change.position + change.velocity);
    if (!std::isfinite(size)) return false;
    const double contraction = iteration == 0 ? 1.0 : size / last;
    // Without contraction, either only rounding errors are left or the step is too long.
    const bool settled = contraction < 1.0 && contraction * size <= (1.0 - contraction) * wanted;
    if (settled || size <= kRounding) return true;
    if (iteration > 0 && contraction >= 1.0) return change.position <= kRounding;
    last = size;
  }
  return false;
}

RadauStepper::Forces RadauStepper::springForces(std::size_t spring) {
  Forces forces;
  const Ends start = endsOf(spring, begin_);
  Row& tensions = stages_.tensions[spring];
  const PlaneVector<double>& r = springs_[spring].r;
  for (std::size_t s = 0; s < kStages; ++s) {
    const Ends ends = endsOf(spring, start, s);
    const PlaneVector<double>& d = ends.separation;
    const double unit = tensions[s] * inverseSquareRoot(d.x * d.x + d.y * d.y);
    const double tension = tensionOf(ends);
    const double residual = tension - tensions[s];
    forces[0][s] = unit * d.x + residual * r.x;
    forces[1][s] = unit * d.y + residual * r.y;
    tensions[s] = tension;
  }
  return forces;
}

void RadauStepper::computeResiduals() {
  Forces left{};
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    const Forces right = i < springs_.size() ? springForces(i) : Forces{};
    const double mass = massOf(chain_, static_cast<Eigen::Index>(i));
    const auto fall = springlessAcceleration(chain_, i);
    const Increments& increments = stages_.particles[i];
    const double drag = dragOn(i);
    Forces forces;
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t s = 0; s < kStages; ++s) {
        forces[c][s] = (right[c][s] - left[c][s]) + mass * fall[c];
        if (drag == 0.0) continue;
        forces[c][s] -= drag * (valueOf(begin_, i, 2 + c) + increments[2 + c][s]);
      }
    }
    real_.setRightHandSide(i, mass, increments, forces);
    for (System<Complex>& pair : pairs_) pair.setRightHandSide(i, mass, increments, forces);
    left = right;
  }
  statistics_.force_evaluations += static_cast<std::int64_t>(kStages);
}

LargestChange RadauStepper::updateStages() {
  const double damping = chain_.spring().damping;
  LargestChange largest{};
  double finite = 0.0;
  Increments left{};
  for (std::size_t i = 1; i < stages_.particles.size(); ++i) {
    Increments change{};
    real_.addChange(i, change);
    for (const System<Complex>& pair : pairs_) pair.addChange(i, change);
    const LinearSpring& spring = springs_[i - 1];
    Increments& stage = stages_.particles[i];
    for (std::size_t s = 0; s < kStages; ++s) {
      for (std::size_t c = 0; c < 4; ++c) stage[c][s] += change[c][s];
      const auto grown = [&](std::size_t c) { return change[c][s] - left[c][s]; };
      stages_.tensions[i - 1][s] +=
          spring.tensionChange(damping, {grown(0), grown(1)}, {grown(2), grown(3)});
      const auto size = [&](std::size_t c) { return std::abs(change[c][s]); };
      largest.position = std::max({largest.position, size(0), size(1)});
      largest.velocity = std::max({largest.velocity, size(2), size(3)});
      finite += 0.0 * (change[2][s] + change[3][s]);
    }
    left = change;
  }
  largest.velocity += finite;  // std::max may drop a NaN
  return largest;
}

double RadauStepper::estimateError(double h) {
  const double error = filteredError(false);
  if (previous_length_ > 0.0 && error <= allowed_rate_ * h) return error;
  return filteredError(true);
}

// The tension at the start is that at the end of the last step. Computed from the spring law, it
// would contain rounding errors of the velocities, amplified to forces that are large for a light
// particle.
PlaneVector<double> RadauStepper::startForce(std::size_t spring, bool corrected) const {
  const LinearSpring& linear = springs_[spring];
  Ends ends = endsOf(spring, begin_);
  double tension = previous_length_ > 0.0 ? previous_.tensions[spring].back() : tensionOf(ends);
  if (corrected) {
    const Ends change = endsOf(spring, change_);
    ends.separation.x += change.separation.x;
    ends.separation.y += change.separation.y;
    tension +=
        linear.tensionChange(chain_.spring().damping, change.separation, change.relative_velocity);
  }
  const PlaneVector<double>& d = ends.separation;
  const double unit = tension * inverseSquareRoot(d.x * d.x + d.y * d.y);
  return {unit * d.x, unit * d.y};
}

double RadauStepper::filteredError(bool corrected) {
  const double q = real_.q;
  const auto position_part = [&](std::size_t i, std::size_t c) {
    return q * valueOf(begin_, i, 2 + c) + radau::dot(radau::kError, stages_.particles[i][c]);
  };
  std::array<double, 2> here{}, left{};
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    std::array<double, 2> right{}, next{};
    if (i < springs_.size()) {
      next = {position_part(i + 1, 0), position_part(i + 1, 1)};
      const PlaneVector<double> force = startForce(i, corrected);
      const PlaneVector<double> change =
          springs_[i].stiffnessTimes({next[0] - here[0], next[1] - here[1]});
      right = {q * (force.x + change.x), q * (force.y + change.y)};
    }
    const double mass = massOf(chain_, static_cast<Eigen::Index>(i));
    const auto fall = springlessAcceleration(chain_, i);
    const double drag = dragOn(i);
    for (std::size_t c = 0; c < 2; ++c) {
      double& sum = real_.unknowns[c][i];
      const double error = radau::dot(radau::kError, stages_.particles[i][2 + c]);
      sum = mass * (error + q * fall[c]) + (right[c] - left[c]);
      if (drag == 0.0) continue;
      const double change = corrected ? valueOf(change_, i, 2 + c) : 0.0;
      sum -= q * (drag * (valueOf(begin_, i, 2 + c) + change));
    }
    here = next;
    left = right;
  }
  real_.solve();
  ++statistics_.force_evaluations;
  for (std::size_t c = 0; c < 4; ++c) valueOf(change_, 0, c) = 0.0;
  double largest = 0.0, finite = 0.0;
  for (std::size_t i = 1; i < stages_.particles.size(); ++i) {
    for (std::size_t c = 0; c < 2; ++c) {
      const double velocity = real_.unknowns[c][i];
      const double error = position_part(i, c) + q * velocity;
      valueOf(change_, i, c) = error;
      valueOf(change_, i, 2 + c) = velocity;
      largest = std::max(largest, std::abs(error));
      finite += 0.0 * error;
    }
  }
  return largest + finite;
}

double RadauStepper::stepExplicitly(double h) {
  kernels_.stageSlope(constants_.chain(), begin_.data(), kNoSlopes, change_.data());
  ++statistics_.force_evaluations;
  double finite = 0.0;
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const double slope = valueOf(change_, i, c);
      for (std::size_t s = 0; s < kStages; ++s)
        stages_.particles[i][c][s] = (h * radau::kNodes[s]) * slope;
      finite += 0.0 * slope;
    }
  }
  for (std::size_t i = 0; i < springs_.size(); ++i)
    stages_.tensions[i].fill(tensionOf(endsOf(i, begin_)));
  setEndFromLastStage();
  return finite;
}

void RadauStepper::setEndFromLastStage() {
  for (std::size_t i = 0; i < stages_.particles.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      valueOf(change_, i, c) = valueOf(carry_, i, c) + stages_.particles[i][c].back();
  setEnd(change_, kNoSlopes);
}

const StateBuffer& RadauStepper::stateInside(double fraction) const {
  const Row weights = radau::lagrangeWeights(fraction, true);
  change_.values() = begin_.values();
  for (std::size_t i = 0; i < stages_.particles.size(); ++i)
    for (std::size_t c = 0; c < 4; ++c)
      valueOf(change_, i, c) += radau::dot(weights, stages_.particles[i][c]);
  return change_;
}

}  // namespace spring_pendulum

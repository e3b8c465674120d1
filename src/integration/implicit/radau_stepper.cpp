#include "integration/implicit/radau_stepper.hpp"

#include "integration/work.hpp"

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

void setRow(StateBuffer& buffer, std::size_t particle, const double (&values)[4]) {
  double* const row = buffer.particle(static_cast<Eigen::Index>(particle));
  for (std::ptrdiff_t c = 0; c < 4; ++c) row[c * buffer.pitch()] = values[c];
}

}  // namespace

StepStatistics RadauStepper::statistics() const {
  StepStatistics statistics = ErrorEstimatingStepper::statistics();
  const double cost = kRadauTime.of(chain().size()) / kTaylorTime.of(chain().size());
  statistics.extra_work = (cost - 1.0) * static_cast<double>(statistics.force_evaluations);
  return statistics;
}

RadauStepper::RadauStepper(const Chain& chain, double tolerance, const ChainKernels& kernels)
    : ErrorEstimatingStepper(chain,
                             {kShareOfTolerance * tolerance, static_cast<int>(kStages),
                              kFirstStep * root(kShareOfTolerance * tolerance, kErrorOrder)},
                             kernels),
      allowed_rate_(kShareOfTolerance * tolerance),
      stages_(chain.size()),
      previous_(chain.size()),
      springs_(static_cast<std::size_t>(chain.size() - 1)),
      real_(this->chain(), radau::kReal),
      pairs_{{{this->chain(), radau::kPairs[0]}, {this->chain(), radau::kPairs[1]}}},
      change_(chain.size()) {}

void RadauStepper::prepare(bool restarted) {
  std::swap(stages_, previous_);
  previous_length_ = restarted ? 0.0 : statistics().last_step;
}

double RadauStepper::attempt(double h) {
  if (h <= kShortestStep) return stepExplicitly(h);
  predict(h);
  linearise();
  real_.factor(springs_, h);
  for (System<Complex>& pair : pairs_) pair.factor(springs_, h);
  if (!solveStages(h)) return kErrorOfFailure * allowed_rate_;
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
  return {{start.separation.x + (b.x[stage] - a.x[stage]),
           start.separation.y + (b.y[stage] - a.y[stage])},
          {start.relative_velocity.x + (b.vx[stage] - a.vx[stage]),
           start.relative_velocity.y + (b.vy[stage] - a.vy[stage])}};
}

void RadauStepper::predict(double h) {
  const double ratio = previous_length_ > 0.0 ? h / previous_length_ : 0.0;
  std::array<Row, kStages> weights{}, tension_weights{};
  for (std::size_t s = 0; s < kStages; ++s) {
    weights[s] = radau::lagrangeWeights(1.0 + ratio * radau::kNodes[s], true);
    tension_weights[s] = radau::lagrangeWeights(1.0 + ratio * radau::kNodes[s], false);
  }
  const auto guess = [&](double velocity, const Row& old, Row& position, Row& change) {
    for (std::size_t s = 0; s < kStages; ++s) {
      change[s] = previous_length_ > 0.0 ? radau::dot(weights[s], old) - old.back() : 0.0;
    }
    for (std::size_t s = 0; s < kStages; ++s) {
      position[s] = h * (radau::kNodes[s] * velocity + radau::dot(radau::kMatrix[s], change));
    }
  };
  const std::ptrdiff_t pitch = begin().pitch();
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    const double* velocity = begin().particle(static_cast<Eigen::Index>(i)) + 2 * pitch;
    const Increments& old = previous_.particles[i];
    Increments& next = stages_.particles[i];
    guess(velocity[0], old.vx, next.x, next.vx);
    guess(velocity[pitch], old.vy, next.y, next.vy);
  }
  if (chain().isDriven()) setAnchor(h);
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    Row& tensions = stages_.tensions[i];
    const Ends ends = endsOf(i, begin());
    tensions.fill(springTension(chain().spring(), ends.separation, ends.relative_velocity));
    if (previous_length_ == 0.0) continue;
    for (std::size_t s = 0; s < kStages; ++s) {
      tensions[s] = radau::dot(tension_weights[s], previous_.tensions[i]);
    }
  }
}

void RadauStepper::setAnchor(double h) {
  const PlaneVector<double> speed = velocityOf(begin(), 0);
  const PlaneVector<double> acceleration = chain().springlessAcceleration(0);
  Increments& stage = stages_.particles[0];
  for (std::size_t s = 0; s < kStages; ++s) {
    const double time = h * radau::kNodes[s];
    stage.vx[s] = time * acceleration.x;
    stage.vy[s] = time * acceleration.y;
    stage.x[s] = time * (speed.x + 0.5 * stage.vx[s]);
    stage.y[s] = time * (speed.y + 0.5 * stage.vy[s]);
  }
}

void RadauStepper::linearise() {
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Ends middle = endsOf(i, endsOf(i, begin()), kMiddleStage);
    springs_[i] = linearSpring(chain().spring(), middle.separation, middle.relative_velocity,
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
    const Change change = updateStages();
    const double size = change.norm();
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

void RadauStepper::springForces(std::size_t spring, Row& fx, Row& fy) {
  const SpringLaw& law = chain().spring();
  const Ends start = endsOf(spring, begin());
  Row& tensions = stages_.tensions[spring];
  const PlaneVector<double>& r = springs_[spring].r;
  for (std::size_t s = 0; s < kStages; ++s) {
    const Ends ends = endsOf(spring, start, s);
    const PlaneVector<double>& d = ends.separation;
    const double unit = tensions[s] * inverseSquareRoot(d.x * d.x + d.y * d.y);
    const double tension = springTension(law, d, ends.relative_velocity);
    const double residual = tension - tensions[s];
    fx[s] = unit * d.x + residual * r.x;
    fy[s] = unit * d.y + residual * r.y;
    tensions[s] = tension;
  }
}

void RadauStepper::computeResiduals() {
  Row left_x{}, left_y{};
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    Row right_x{}, right_y{};
    if (i < springs_.size()) springForces(i, right_x, right_y);
    const double mass = massOf(chain(), static_cast<Eigen::Index>(i));
    const PlaneVector<double> fall = chain().springlessAcceleration(static_cast<Eigen::Index>(i));
    Row fx, fy;
    for (std::size_t s = 0; s < kStages; ++s) {
      fx[s] = (right_x[s] - left_x[s]) + mass * fall.x;
      fy[s] = (right_y[s] - left_y[s]) + mass * fall.y;
    }
    const Increments& increments = stages_.particles[i];
    subtractDrag(i, fx, fy);
    real_.setRightHandSide(i, mass, increments, fx, fy);
    for (System<Complex>& pair : pairs_) pair.setRightHandSide(i, mass, increments, fx, fy);
    left_x = right_x;
    left_y = right_y;
  }
  counters().force_evaluations += static_cast<std::int64_t>(kStages);
}

RadauStepper::Change RadauStepper::updateStages() {
  const double damping = chain().spring().damping;
  Change largest;
  double finite = 0.0;
  Increments left{};
  for (std::size_t i = 1; i < stages_.particles.size(); ++i) {
    Increments change{};
    real_.addChange(i, change);
    for (const System<Complex>& pair : pairs_) pair.addChange(i, change);
    const LinearSpring& spring = springs_[i - 1];
    Increments& stage = stages_.particles[i];
    for (std::size_t s = 0; s < kStages; ++s) {
      stage.x[s] += change.x[s];
      stage.y[s] += change.y[s];
      stage.vx[s] += change.vx[s];
      stage.vy[s] += change.vy[s];
      stages_.tensions[i - 1][s] +=
          spring.tensionChange(damping, {change.x[s] - left.x[s], change.y[s] - left.y[s]},
                               {change.vx[s] - left.vx[s], change.vy[s] - left.vy[s]});
      largest.position = std::max({largest.position, std::abs(change.x[s]), std::abs(change.y[s])});
      largest.velocity =
          std::max({largest.velocity, std::abs(change.vx[s]), std::abs(change.vy[s])});
      finite += 0.0 * (change.vx[s] + change.vy[s]);
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
  Ends ends = endsOf(spring, begin());
  double tension = previous_length_ > 0.0
                       ? previous_.tensions[spring].back()
                       : springTension(chain().spring(), ends.separation, ends.relative_velocity);
  if (corrected) {
    const Ends change = endsOf(spring, change_);
    ends.separation.x += change.separation.x;
    ends.separation.y += change.separation.y;
    tension +=
        linear.tensionChange(chain().spring().damping, change.separation, change.relative_velocity);
  }
  const PlaneVector<double>& d = ends.separation;
  const double unit = tension * inverseSquareRoot(d.x * d.x + d.y * d.y);
  return {unit * d.x, unit * d.y};
}

double RadauStepper::filteredError(bool corrected) {
  const double q = real_.q;
  const auto position_part = [&](std::size_t i) {
    const double* velocity = begin().particle(static_cast<Eigen::Index>(i)) + 2 * begin().pitch();
    const Increments& stage = stages_.particles[i];
    return PlaneVector<double>{q * velocity[0] + radau::dot(radau::kError, stage.x),
                               q * velocity[begin().pitch()] + radau::dot(radau::kError, stage.y)};
  };
  PlaneVector<double> here{}, left{};
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    PlaneVector<double> right{}, next{};
    if (i < springs_.size()) {
      next = position_part(i + 1);
      const PlaneVector<double> force = startForce(i, corrected);
      const PlaneVector<double> change =
          springs_[i].stiffnessTimes({next.x - here.x, next.y - here.y});
      right = {q * (force.x + change.x), q * (force.y + change.y)};
    }
    const double mass = massOf(chain(), static_cast<Eigen::Index>(i));
    const PlaneVector<double> fall = chain().springlessAcceleration(static_cast<Eigen::Index>(i));
    const Increments& stage = stages_.particles[i];
    real_.x[i] = mass * (radau::dot(radau::kError, stage.vx) + q * fall.x) + (right.x - left.x);
    real_.y[i] = mass * (radau::dot(radau::kError, stage.vy) + q * fall.y) + (right.y - left.y);
    const PlaneVector<double> drag = startDrag(i, corrected);
    real_.x[i] -= q * drag.x;
    real_.y[i] -= q * drag.y;
    here = next;
    left = right;
  }
  real_.solve();
  ++counters().force_evaluations;
  setRow(change_, 0, {0.0, 0.0, 0.0, 0.0});
  double largest = 0.0, finite = 0.0;
  for (std::size_t i = 1; i < stages_.particles.size(); ++i) {
    const PlaneVector<double> part = position_part(i);
    const double errors[] = {part.x + q * real_.x[i], part.y + q * real_.y[i], real_.x[i],
                             real_.y[i]};
    setRow(change_, i, errors);
    largest = std::max({largest, std::abs(errors[0]), std::abs(errors[1])});
    finite += 0.0 * (errors[0] + errors[1]);
  }
  return largest + finite;
}

double RadauStepper::stepExplicitly(double h) {
  kernels().stageSlope(kernelChain(), begin().data(), {}, change_.data());
  ++counters().force_evaluations;
  const std::ptrdiff_t pitch = begin().pitch();
  double finite = 0.0;
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    const double* slope = change_.particle(static_cast<Eigen::Index>(i));
    Increments& stage = stages_.particles[i];
    for (std::size_t s = 0; s < kStages; ++s) {
      const double time = h * radau::kNodes[s];
      stage.x[s] = time * slope[0];
      stage.y[s] = time * slope[pitch];
      stage.vx[s] = time * slope[2 * pitch];
      stage.vy[s] = time * slope[3 * pitch];
    }
    finite += 0.0 * (stage.x[0] + stage.y[0] + stage.vx[0] + stage.vy[0]);
  }
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    const Ends ends = endsOf(i, begin());
    stages_.tensions[i].fill(
        springTension(chain().spring(), ends.separation, ends.relative_velocity));
  }
  setEndFromLastStage();
  return finite;
}

void RadauStepper::setEndFromLastStage() {
  const std::ptrdiff_t pitch = begin().pitch();
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    const Increments& stage = stages_.particles[i];
    const double* lost = carry().particle(static_cast<Eigen::Index>(i));
    const double changes[] = {lost[0] + stage.x.back(), lost[pitch] + stage.y.back(),
                              lost[2 * pitch] + stage.vx.back(), lost[3 * pitch] + stage.vy.back()};
    setRow(change_, i, changes);
  }
  setEnd(change_, {});
}

const StateBuffer& RadauStepper::stateInside(double fraction) const {
  const Row weights = radau::lagrangeWeights(fraction, true);
  auto values = change_.values();
  values = begin().values();
  for (std::size_t i = 0; i < stages_.particles.size(); ++i) {
    const Increments& stage = stages_.particles[i];
    const auto row = static_cast<Eigen::Index>(i);
    values(row, 0) += radau::dot(weights, stage.x);
    values(row, 1) += radau::dot(weights, stage.y);
    values(row, 2) += radau::dot(weights, stage.vx);
    values(row, 3) += radau::dot(weights, stage.vy);
  }
  return change_;
}

}  // namespace spring_pendulum

#include "check/motion.hpp"

#include "integration/work.hpp"
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

/// Rounding errors of a step, in units of the last digit of the largest number. Measured: at most 3
/// for Runge-Kutta-4 in other orders of summation.
constexpr double kRoundingErrors = 16.0;

/// Adds rounding errors to a column of the state, except to the first particle; nothing if all are
/// equal, like x in a vertical chain: their differences are exact.
template <typename Numbers>
void disturbColumn(Numbers numbers, double epsilon, double steps, std::mt19937& random) {
  if (numbers.minCoeff() == numbers.maxCoeff()) return;
  const double size =
      kRoundingErrors * std::sqrt(steps) * epsilon * static_cast<double>(numbers.abs().maxCoeff());
  for (Eigen::Index i = 1; i < numbers.size(); ++i) {
    const double share = static_cast<double>(random()) / std::mt19937::max();
    numbers[i] += static_cast<typename Numbers::Scalar>((2.0 * share - 1.0) * size);
  }
}

class MethodMotion : public Motion {
 public:
  MethodMotion(const Method& method, const Scenario& scenario, const Particles& particles)
      : method_(method),
        chain_(particles.masses, scenario.spring(), scenario.gravity),
        state_(particles.state),
        integrator_(makeIntegrator(method, chain_, {scenario.tolerance, false, 0})) {
    Scenario with_method = scenario;
    with_method.method = method;
    steps_ = frameSteps(with_method);
  }

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    const std::int64_t before = integrator_->forceEvaluations();
    for (std::int64_t left = (frame - frame_) * steps_.steps; left > 0;) {
      if (limit.isStopped()) return false;
      left -= integrator_->advanceWithin(state_, steps_.time_step, left,
                                         integrator_->work() + kWorkBetweenStops);
    }
    limit.done += static_cast<double>((integrator_->forceEvaluations() - before) * state_.size());
    frame_ = frame;
    return true;
  }

  void writePositions(Eigen::ArrayX2d& positions) const override { positions = state_.positions(); }

  void disturb(std::mt19937& random) override {
    for (int column = 0; column < 4; ++column) {
      disturbColumn(state_.values().col(column).array(), std::numeric_limits<double>::epsilon(),
                    static_cast<double>(steps_.steps), random);
    }
    integrator_->restart();
  }

  bool isDisturbedOnce() const override { return !method_.get().hasFixedStep(); }

 private:
  std::reference_wrapper<const Method> method_;
  Chain chain_;
  State state_;
  std::unique_ptr<Integrator> integrator_;
  FrameSteps steps_;
  std::int64_t frame_ = 0;
};

template <typename Real>
class ProgramMotion : public Motion {
  using Row = Eigen::Array<Real, 4, 1>;  ///< x, y, vx, vy
  using Rows = std::vector<Row>;
  using Weights = std::array<double, ButcherTableau::kMaxStages>;
  using Program = StudentProgram;

 public:
  ProgramMotion(const StudentProgram& program, const Particles& particles)
      : program_(program), step_size_(static_cast<Real>(program.time_step)) {
    const std::ptrdiff_t size = particles.state.size();
    for (std::ptrdiff_t i = 0; i < size; ++i) {
      state_.push_back(particles.state.values().row(i).transpose().array().cast<Real>());
      const double mass = particles.masses[i];
      force_factor_.push_back(static_cast<Real>(std::pow(mass, program.force_mass_power)));
      const double gravity_factor = std::pow(mass, program.gravity_mass_power);
      gravity_.emplace_back(static_cast<Real>(program.gravity_x * gravity_factor),
                            static_cast<Real>(program.gravity * gravity_factor));
    }
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const Row separation = state_[i] - state_[i > 0 ? i - 1 : 0];
      rest_lengths_.push_back(program.rest_length_from_start
                                  ? std::sqrt(separation.template head<2>().square().sum())
                                  : static_cast<Real>(program.rest_length));
    }
    slopes_.assign(program.tableau.stages, Rows(state_.size(), Row::Zero()));
  }

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    const std::int64_t target = program_.stepOfFrame(frame);
    limit.done += static_cast<double>(target - step_) *
                  static_cast<double>(program_.tableau.stages) *
                  static_cast<double>(state_.size()) * kWorkOfSpring;
    for (; step_ < target; ++step_) {
      if (limit.isStopped()) return false;
      switch (program_.order) {
        case Program::Order::kForceAfterMove:
          moveFirst();
          break;
        case Program::Order::kParticlesInPlace:
        case Program::Order::kFrozenNeighbours:
          stepParticleByParticle();
          break;
        default:
          stepStageByStage();
      }
    }
    return true;
  }

  void writePositions(Eigen::ArrayX2d& positions) const override {
    positions.resize(static_cast<Eigen::Index>(state_.size()), 2);
    const int x = program_.swaps_columns ? 1 : 0;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      positions(row, 0) = static_cast<double>(state_[i][x]);
      positions(row, 1) = static_cast<double>(state_[i][1 - x]);
    }
  }

  void disturb(std::mt19937& random) override {
    using Matrix = Eigen::Array<Real, 4, Eigen::Dynamic>;
    Eigen::Map<Matrix> numbers(state_.front().data(), 4, static_cast<Eigen::Index>(state_.size()));
    for (Eigen::Index column = 0; column < 4; ++column) {
      disturbColumn(numbers.row(column), static_cast<double>(std::numeric_limits<Real>::epsilon()),
                    static_cast<double>(program_.steps_per_frame), random);
    }
  }

 private:
  static constexpr double kWorkOfSpring = 10.0;  ///< relative to a kernel of the library

  /// The force on a particle at row `here` of the spring to its neighbour at row `there`.
  auto springForce(const Row& here, const Row& there, Real rest_length) const {
    using Vector = Eigen::Array<Real, 2, 1>;
    const Vector d = there.template head<2>() - here.template head<2>();
    const Vector w = there.template tail<2>() - here.template tail<2>();
    const Real length = std::sqrt(d.square().sum());
    const Vector r = d / length;
    const Vector direction = program_.unit_direction ? r : d;
    const auto damping = static_cast<Real>(program_.damping);
    const Real tension = static_cast<Real>(program_.stiffness) * (length - rest_length);
    switch (program_.damping_kind) {
      case Program::Damping::kAllDirections:
        return Vector(tension * direction + damping * w);
      case Program::Damping::kOwnVelocity:
        return Vector(tension * direction - damping * here.template tail<2>());
      case Program::Damping::kUnnormalisedProjection:
        return Vector((tension + damping * (w * d).sum()) * direction);
      default:
        return Vector((tension + damping * (w * r).sum()) * direction);
    }
  }

  Row slope(const Rows& z, std::size_t i) const {
    Row result = Row::Zero();
    const bool is_last = i + 1 == z.size();
    if ((i == 0 && !program_.first_moves) || (is_last && !program_.last_moves)) return result;
    auto acceleration = result.template tail<2>();
    if (i > 0 && program_.left != 0.0)
      acceleration +=
          static_cast<Real>(program_.left) * springForce(z[i], z[i - 1], rest_lengths_[i]);
    if (!is_last && program_.right != 0.0) {
      acceleration +=
          static_cast<Real>(program_.right) * springForce(z[i], z[i + 1], rest_lengths_[i + 1]);
    }
    acceleration = acceleration * force_factor_[i] - gravity_[i];
    result.template head<2>() = z[i].template tail<2>();
    if (program_.position_update == Program::PositionUpdate::kNewVelocityInSlopes)
      result.template head<2>() += step_size_ * acceleration;
    return result;
  }

  /// Row i of the next stage, or of the result.
  Row moved(std::size_t i, std::size_t stages, bool is_result) const {
    const Weights& weights = is_result ? program_.tableau.b : program_.tableau.a[stages];
    Row change = Row::Zero();
    Real sum = 0;
    for (std::size_t j = 0; j < stages; ++j) {
      if (weights[j] == 0.0) continue;
      change += static_cast<Real>(weights[j]) * slopes_[j][i];
      sum += static_cast<Real>(weights[j]);
    }
    const Row& start = state_[i];
    if (is_result && program_.velocity_by_euler)
      change.template tail<2>() = slopes_[0][i].template tail<2>();
    if (!is_result && program_.stage_moves == Program::StageMoves::kPositions)
      change.template tail<2>().setZero();
    if (!is_result && program_.stage_moves == Program::StageMoves::kVelocities)
      change.template head<2>().setZero();
    Row result = start + step_size_ * change;
    using Update = Program::PositionUpdate;
    const Update update = program_.position_update;
    if (update == Update::kNewVelocityEverywhere ||
        update == (is_result ? Update::kNewVelocityInResult : Update::kNewVelocityInStages)) {
      result.template head<2>() =
          start.template head<2>() + step_size_ * sum * result.template tail<2>();
    }
    if (is_result && update == Update::kOldVelocity)
      result.template head<2>() = start.template head<2>() + step_size_ * start.template tail<2>();
    if (i == 0 && !program_.first_moves) return start;
    return result;
  }

  void stepStageByStage() {
    const std::size_t stages = program_.tableau.stages;
    Rows& stage = scratch_;
    stage = state_;
    Rows& next = next_;
    next.resize(stage.size());
    for (std::size_t s = 0; s < stages; ++s) {
      for (std::size_t i = 0; i < stage.size(); ++i) {
        slopes_[s][i] = slope(stage, i);
        next[i] = moved(i, s + 1, s + 1 == stages);
        if (program_.order == Program::Order::kStagesInPlace) stage[i] = next[i];
        if (program_.order == Program::Order::kPositionsInPlace)
          stage[i].template head<2>() = next[i].template head<2>();
      }
      std::swap(stage, next);
    }
    std::swap(state_, stage);
  }

  void stepParticleByParticle() {
    const std::size_t stages = program_.tableau.stages;
    scratch_ = state_;
    next_ = state_;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      for (std::size_t s = 0; s < stages; ++s) {
        slopes_[s][i] = slope(scratch_, i);
        scratch_[i] = moved(i, s + 1, s + 1 == stages);
      }
      next_[i] = scratch_[i];
      if (program_.order == Program::Order::kFrozenNeighbours) scratch_[i] = state_[i];
    }
    std::swap(state_, next_);
  }

  void moveFirst() {
    for (std::size_t i = program_.first_moves ? 0 : 1; i < state_.size(); ++i)
      state_[i].template head<2>() += step_size_ * state_[i].template tail<2>();
    for (std::size_t i = 0; i < state_.size(); ++i) slopes_[0][i] = slope(state_, i);
    for (std::size_t i = 0; i < state_.size(); ++i)
      state_[i].template tail<2>() += step_size_ * slopes_[0][i].template tail<2>();
  }

  StudentProgram program_;
  Real step_size_;  ///< s
  Rows state_;
  Rows scratch_;
  Rows next_;
  std::vector<Rows> slopes_;        ///< by stage and particle
  std::vector<Real> force_factor_;  ///< 1/kg for the right program
  std::vector<Eigen::Array<Real, 2, 1>> gravity_;
  std::vector<Real> rest_lengths_;  ///< of the spring before each particle, m
  std::int64_t step_ = 0;
};

}  // namespace

std::unique_ptr<Motion> motionOf(const Method& method, const Scenario& scenario,
                                 const Particles& particles) {
  return std::make_unique<MethodMotion>(method, scenario, particles);
}

std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Particles& particles) {
  if (program.single_precision) return std::make_unique<ProgramMotion<float>>(program, particles);
  return std::make_unique<ProgramMotion<double>>(program, particles);
}

}  // namespace spring_pendulum

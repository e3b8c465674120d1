#include "check/motion.hpp"

#include <spring_pendulum/simulation/frame_steps.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

/// Adds rounding errors to a column of the state, except to the first particle; nothing if all are
/// equal, like x in a vertical chain: their differences are exact.
/// \param epsilon of the numbers of the program
template <typename Numbers>
void disturbColumn(Numbers&& numbers, double epsilon, std::int64_t steps, std::mt19937& random) {
  // Errors of a step in units of the last digit. Measured: at most 3 for Runge-Kutta-4 in other orders
  // of summation.
  constexpr double kRoundingErrors = 16.0;
  if (numbers.minCoeff() == numbers.maxCoeff()) return;
  const double size =
      kRoundingErrors * std::sqrt(static_cast<double>(steps)) * epsilon * numbers.abs().maxCoeff();
  for (Eigen::Index i = 1; i < numbers.size(); ++i) {
    const double share = static_cast<double>(random()) / std::mt19937::max();
    numbers[i] += (2.0 * share - 1.0) * size;
  }
}

class MethodMotion : public Motion {
 public:
  MethodMotion(const Method& method, const Scenario& scenario, const Particles& particles)
      : tolerance_(method.hasFixedStep() ? 0.0 : scenario.tolerance),
        chain_(particles.masses, scenario.spring(), scenario.gravity),
        state_(particles.state),
        integrator_(makeIntegrator(method, chain_, {scenario.tolerance, false, 0})),
        frame_(particles.frame) {
    Scenario with_method = scenario;
    with_method.method = method;
    steps_ = frameSteps(with_method);
  }

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    const std::int64_t before = integrator_->forceEvaluations();
    const std::int64_t steps = (frame - frame_) * steps_.steps;
    const auto stop = [&limit] { return limit.isStopped(); };
    if (integrator_->advance(state_, steps_.time_step, steps, stop) < steps) return false;
    limit.done += static_cast<double>((integrator_->forceEvaluations() - before) * state_.size());
    frame_ = frame;
    return true;
  }

  Eigen::ArrayX2d positions() const override { return state_.positions(); }

  void disturb(std::mt19937& random) override {
    for (int column = 0; column < 4; ++column) {
      disturbColumn(state_.values().col(column).array(), std::numeric_limits<double>::epsilon(),
                    steps_.steps, random);
    }
    integrator_->restart();
  }

  double tolerance() const override { return tolerance_; }

 private:
  double tolerance_;  ///< m
  Chain chain_;
  State state_;
  std::unique_ptr<Integrator> integrator_;
  FrameSteps steps_;
  std::int64_t frame_;
};

class ProgramMotion : public Motion {
  using Vector = Eigen::Array2d;
  using Row = Eigen::Array4d;  ///< x, y, vx, vy
  using Rows = std::vector<Row>;
  using Program = StudentProgram;

 public:
  ProgramMotion(const StudentProgram& program, const Particles& particles)
      : program_(program), first_frame_(particles.frame) {
    const std::ptrdiff_t size = particles.state.size();
    for (std::ptrdiff_t i = 0; i < size; ++i) {
      Row row = particles.state.values().row(i).transpose().array();
      if (program.single_precision) row = row.cast<float>().cast<double>();
      const Row separation = row - (i > 0 ? state_.back() : row);
      rest_lengths_.push_back(program.rest_length_from_start ? separation.head<2>().matrix().norm()
                                                             : program.rest_length);
      state_.push_back(row);
      const std::ptrdiff_t other = std::clamp<std::ptrdiff_t>(i + program.mass_of, 0, size - 1);
      force_factor_.push_back(std::pow(particles.masses[other], program.force_mass_power));
      const bool falls = !program.gravity_on_last_only || i + 1 == size;
      const double factor = std::pow(particles.masses[i], program.gravity_mass_power);
      gravity_.emplace_back((falls ? factor : 0.0) * Vector(program.gravity_x, program.gravity));
    }
    slopes_.assign(program.tableau.stages, Rows(state_.size(), Row::Zero()));
  }

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    constexpr double kWorkOfSpring = 10.0;  // relative to a kernel of the library
    const std::int64_t target = program_.stepOfFrame(frame - first_frame_);
    limit.done += static_cast<double>(target - step_) * kWorkOfSpring *
                  static_cast<double>(program_.tableau.stages * state_.size());
    for (; step_ < target; ++step_) {
      if (limit.isStopped()) return false;
      const bool by_particle = program_.order == Program::Order::kParticlesInPlace ||
                               program_.order == Program::Order::kFrozenNeighbours;
      by_particle ? stepParticleByParticle() : stepStageByStage();
    }
    return true;
  }

  Eigen::ArrayX2d positions() const override {
    Eigen::ArrayX2d result(static_cast<Eigen::Index>(state_.size()), 2);
    for (Eigen::Index i = 0; i < result.rows(); ++i)
      result.row(i) = state_[static_cast<std::size_t>(i)].head<2>().transpose();
    if (program_.reverses_particles) result = result.colwise().reverse().eval();
    if (program_.swaps_columns) result = result.rowwise().reverse().eval();
    return result;
  }

  void disturb(std::mt19937& random) override {
    const double epsilon = program_.single_precision ? std::numeric_limits<float>::epsilon()
                                                     : std::numeric_limits<double>::epsilon();
    Eigen::Map<Eigen::Array<double, 4, Eigen::Dynamic>> numbers(
        state_.front().data(), 4, static_cast<Eigen::Index>(state_.size()));
    for (Eigen::Index column = 0; column < 4; ++column)
      disturbColumn(numbers.row(column), epsilon, program_.steps_per_frame, random);
  }

 private:
  /// The force on a particle at row `here` of the spring to its neighbour at row `there`.
  /// \param sign -1 if this is the previous particle, else 1
  Vector springForce(const Row& here, const Row& there, double rest_length, double sign) const {
    using Damping = Program::Damping;
    using Direction = Program::Direction;
    using Length = Program::Length;
    const Vector d = there.head<2>() - here.head<2>();
    const Vector w = there.tail<2>() - here.tail<2>();
    const double square = d.square().sum();
    double length = program_.length == Length::kSquaredEverywhere ? square : std::sqrt(square);
    Vector r = d / length;
    if (program_.direction >= Direction::kDegrees) {
      constexpr double kDegrees = 57.295779513082320877;
      if (program_.direction == Direction::kDegrees) sign = 1.0;
      const double angle = kDegrees * std::atan2(sign * d.y(), sign * d.x());
      r = sign * Vector(std::cos(angle), std::sin(angle));
    }
    if (program_.length == Length::kInteger) length = std::trunc(length);
    if (program_.length == Length::kSquared) length = square;
    const Vector direction = program_.direction == Direction::kSeparation ? d : r;
    const Vector tension = program_.stiffness * (length - rest_length) * direction;
    const double rate = (w * (program_.damping_kind == Damping::kNotUnit ? d : r)).sum();
    switch (program_.damping_kind) {
      case Damping::kWhole:
        return tension + program_.damping * w;
      case Damping::kOwn:
        return tension - program_.damping * here.tail<2>();
      case Damping::kAbsolute:
        return tension + program_.damping * std::abs(rate) * direction;
      default:
        return tension + program_.damping * rate * direction;
    }
  }

  /// Whether the program has the spring between particle i and the one before.
  bool hasSpring(std::size_t i) const {
    if (program_.springs == Program::Springs::kAllButLast) return i + 1 < state_.size();
    return program_.springs == Program::Springs::kAll || i % 2 == 1;
  }

  Row slope(const Rows& z, std::size_t i) const {
    Row result = Row::Zero();
    const bool is_last = i + 1 == z.size();
    if ((i == 0 && !program_.first_moves) || (is_last && !program_.last_moves)) return result;
    Vector force = Vector::Zero();
    if (i > 0 && program_.left != 0.0 && hasSpring(i))
      force += program_.left * springForce(z[i], z[i - 1], rest_lengths_[i], -1.0);
    if (!is_last && program_.right != 0.0 && hasSpring(i + 1))
      force += program_.right * springForce(z[i], z[i + 1], rest_lengths_[i + 1], 1.0);
    const Vector acceleration = force * force_factor_[i] - gravity_[i];
    result << z[i].tail<2>(), acceleration;
    if (program_.position_update == Program::PositionUpdate::kNewVelocityInSlopes)
      result.head<2>() += program_.time_step * acceleration;
    return result;
  }

  /// Row i of the next stage, or of the result.
  Row moved(std::size_t i, std::size_t stages) const {
    using Update = Program::PositionUpdate;
    const Row& start = state_[i];
    if (i == 0 && !program_.first_moves) return start;
    const bool is_result = stages == program_.tableau.stages;
    const auto& weights = is_result ? program_.tableau.b : program_.tableau.a[stages];
    const Update update = program_.position_update;
    const double step = program_.time_step;
    Row change = Row::Zero();
    double sum = 0.0;
    for (std::size_t j = 0; j < stages; ++j) {
      if (weights[j] == 0.0) continue;
      change += weights[j] * slopes_[j][i];
      sum += weights[j];
    }
    if (is_result && program_.velocity_by_euler) change.tail<2>() = slopes_[0][i].tail<2>();
    if (is_result && update == Update::kOldVelocity) change.head<2>() = start.tail<2>();
    if (!is_result && program_.stage_moves == Program::StageMoves::kPositions)
      change.tail<2>().setZero();
    if (!is_result && program_.stage_moves == Program::StageMoves::kVelocities)
      change.head<2>().setZero();
    Row result = start + step * change;
    if (update == Update::kNewVelocityEverywhere ||
        update == (is_result ? Update::kNewVelocityInResult : Update::kNewVelocityInStages)) {
      result.head<2>() = start.head<2>() + step * sum * result.tail<2>();
    }
    return result;
  }

  void stepStageByStage() {
    scratch_ = state_;
    next_.resize(state_.size());
    if (program_.order == Program::Order::kForceAfterMove) {
      for (std::size_t i = program_.first_moves ? 0 : 1; i < state_.size(); ++i)
        scratch_[i].head<2>() += program_.time_step * state_[i].tail<2>();
    }
    for (std::size_t s = 0; s < slopes_.size(); ++s) {
      for (std::size_t i = 0; i < state_.size(); ++i) {
        slopes_[s][i] = slope(scratch_, i);
        next_[i] = moved(i, s + 1);
        if (program_.order == Program::Order::kStagesInPlace) scratch_[i] = next_[i];
        if (program_.order == Program::Order::kPositionsInPlace)
          scratch_[i].head<2>() = next_[i].head<2>();
      }
      std::swap(scratch_, next_);
    }
    std::swap(state_, scratch_);
  }

  void stepParticleByParticle() {
    scratch_ = state_;
    next_ = state_;
    for (std::size_t i = 0; i < state_.size(); ++i) {
      for (std::size_t s = 0; s < slopes_.size(); ++s) {
        slopes_[s][i] = slope(scratch_, i);
        scratch_[i] = moved(i, s + 1);
      }
      next_[i] = scratch_[i];
      if (program_.order == Program::Order::kFrozenNeighbours) scratch_[i] = state_[i];
    }
    std::swap(state_, next_);
  }

  StudentProgram program_;
  std::int64_t first_frame_;
  Rows state_, scratch_, next_;
  std::vector<Rows> slopes_;          ///< by stage and particle
  std::vector<double> force_factor_;  ///< 1/kg for the right program
  std::vector<Vector> gravity_;       ///< m/s²
  std::vector<double> rest_lengths_;  ///< of the spring before each particle, m
  std::int64_t step_ = 0;
};

}  // namespace

std::unique_ptr<Motion> motionOf(const Method& method, const Scenario& scenario,
                                 const Particles& particles) {
  return std::make_unique<MethodMotion>(method, scenario, particles);
}

std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Particles& particles) {
  return std::make_unique<ProgramMotion>(program, particles);
}

}  // namespace spring_pendulum

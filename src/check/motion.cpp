#include "check/motion.hpp"

#include <spring_pendulum/simulation/plan.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr double kPrecision = std::numeric_limits<double>::epsilon();
constexpr double kPrecisionOfSolvers = 1e-9;  ///< at which students end an iteration

/// Adds rounding errors to one column of the state, except to the first particle; nothing if all
/// numbers are equal, like x in a vertical chain: their differences are exact.
/// \param precision relative precision of the numbers of the program
template <typename Numbers>
void disturbNumbers(Numbers&& numbers, double precision, std::int64_t steps, std::mt19937& random) {
  // Errors of a step in units of the last digit; measured: at most 3 in other orders of summation.
  constexpr double kRoundingErrors = 16.0;
  if (numbers.minCoeff() == numbers.maxCoeff()) return;
  const double size = kRoundingErrors * std::sqrt(static_cast<double>(steps)) * precision *
                      numbers.abs().maxCoeff();
  for (Eigen::Index i = 1; i < numbers.size(); ++i) {
    const double share = static_cast<double>(random()) / std::mt19937::max();
    numbers[i] += (2.0 * share - 1.0) * size;
  }
}

class MethodMotion : public Motion {
 public:
  MethodMotion(const Method& method, const Scenario& scenario, const Scene& particles)
      : tolerance_(method.hasFixedStep() ? 0.0 : scenario.tolerance),
        precision_(isImplicit(method) ? kPrecisionOfSolvers : kPrecision),
        chain_(particles.masses, scenario.constants),
        state_(particles.state),
        integrator_(makeIntegrator(method, chain_, {scenario.tolerance, false, 0})),
        plan_(scenario),
        frame_(particles.frame) {
    plan_.method = method;
  }

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    const std::int64_t before = integrator_->forceEvaluations();
    const std::int64_t steps = (frame - frame_) * plan_.steps();
    const auto stop = [&limit] { return limit.isStopped(); };
    if (integrator_->advance(state_, plan_.step(), steps, stop) < steps) return false;
    limit.done += static_cast<double>((integrator_->forceEvaluations() - before) * state_.size());
    frame_ = frame;
    return true;
  }

  Eigen::ArrayX2d positions() const override { return state_.positions(); }

  void disturb(std::mt19937& random) override {
    for (int column = 0; column < 4; ++column) {
      disturbNumbers(state_.values().col(column).array(), precision_, plan_.steps(), random);
    }
    integrator_->restart();
  }

  double tolerance() const override { return tolerance_; }

 private:
  double tolerance_;  ///< m
  double precision_;
  Chain chain_;
  State state_;
  std::unique_ptr<Integrator> integrator_;
  Plan plan_;
  std::int64_t frame_;
};

class ProgramMotion : public Motion {
  using Vector = Eigen::Array2d;
  using Vectors = Eigen::Array2Xd;  ///< by particle
  using Row = Eigen::Array4d;       ///< x, y, vx, vy
  using Rows = Eigen::Array4Xd;     ///< by particle
  using Order = StudentProgram::Order;
  using Implicit = StudentProgram::Implicit;

 public:
  ProgramMotion(const StudentProgram& program, const Scene& particles)
      : program_(program),
        first_frame_(particles.frame),
        state_(particles.state.values().transpose().array()) {
    if (program.single_precision) state_ = state_.cast<float>().cast<double>().eval();
    const AlignedNumbers& masses = particles.masses;
    const Eigen::Index last = masses.size() - 1;
    for (Eigen::Index i = 0; i <= last; ++i) {
      particles_.push_back({i, last, masses[i], masses[std::max<Eigen::Index>(i - 1, 0)],
                            masses[std::min(i + 1, last)], program.air_drag,
                            Vector(0.0, -program.gravity)});
      for (const auto change : program.particles) change(particles_.back());
      const Row separation = state_.col(i) - state_.col(std::max<Eigen::Index>(i - 1, 0));
      start_lengths_.push_back(separation.head<2>().matrix().norm());
    }
    slopes_.assign(program.tableau.stages, Rows::Zero(4, state_.cols()));
  }

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    const std::int64_t target = program_.stepOfFrame(frame - first_frame_);
    const bool is_implicit = program_.implicit != Implicit::kNone;
    const auto size = static_cast<double>(state_.cols());
    // Relative to a kernel of the library.
    const double work_of_spring = is_implicit ? (200.0 + 3.0 * size) * size : 10.0;
    limit.done += static_cast<double>(target - step_) * work_of_spring * size *
                  static_cast<double>(slopes_.size());
    for (; step_ < target; ++step_) {
      if (limit.isOver()) return false;
      is_implicit ? stepImplicitly() : step();
    }
    return true;
  }

  Eigen::ArrayX2d positions() const override {
    Rows numbers = state_;
    for (const auto change : program_.prints) change(numbers);
    return numbers.topRows<2>().transpose();
  }

  void disturb(std::mt19937& random) override {
    const double precision = program_.single_precision ? std::numeric_limits<float>::epsilon()
                             : program_.implicit != Implicit::kNone ? kPrecisionOfSolvers
                                                                    : kPrecision;
    for (Eigen::Index row = 0; row < 4; ++row)
      disturbNumbers(state_.row(row), precision, program_.steps_per_frame, random);
  }

 private:
  /// The force on particle i of the spring to its neighbour j.
  Vector springForce(const Rows& z, Eigen::Index i, Eigen::Index j) const {
    const Row difference = z.col(j) - z.col(i);
    const Vector separation = difference.head<2>();
    StudentSpring spring{separation,
                         difference.tail<2>(),
                         z.col(i).tail<2>(),
                         j < i,
                         start_lengths_[static_cast<std::size_t>(std::max(i, j))],
                         program_.spring.rest_length,
                         separation.matrix().norm()};
    spring.pointTo(separation / spring.length);
    for (const auto change : program_.springs) change(spring);
    return program_.spring.stiffness * (spring.length - spring.rest_length) * spring.direction +
           program_.spring.damping * spring.damped;
  }

  Row slope(const Rows& z, Eigen::Index i) const {
    const StudentParticle& particle = particles_[static_cast<std::size_t>(i)];
    Row result = Row::Zero();
    if (!particle.moves) return result;
    const Vector velocity = z.col(i).tail<2>();
    Vector force = Vector::Zero();
    if (i > 0 && particle.left != 0.0) force += particle.left * springForce(z, i, i - 1);
    if (i < particle.last && particle.right != 0.0)
      force += particle.right * springForce(z, i, i + 1);
    if (particle.drag != 0.0)
      force -= particle.drag * std::pow(velocity.matrix().norm(), particle.drag_power) * velocity;
    result << velocity, force / particle.divisor + particle.gravity;
    return result;
  }

  /// Row i of the next stage, or of the result.
  Row moved(Eigen::Index i, std::size_t stages) const {
    const bool ends_step = stages == slopes_.size();
    const auto& weights = ends_step ? program_.tableau.b : program_.tableau.a[stages];
    Row change = Row::Zero();
    double sum = 0.0;
    for (std::size_t j = 0; j < stages; ++j) {
      if (weights[j] == 0.0) continue;
      change += weights[j] * slopes_[j].col(i);
      sum += weights[j];
    }
    const double step = program_.time_step;
    StudentMove move{state_.col(i), slopes_[0].col(i), state_.col(i) + step * change,
                     step,          sum * step,        ends_step};
    if (particles_[static_cast<std::size_t>(i)].moves) {
      for (const auto change_move : program_.moves) change_move(move);
    }
    return move.result;
  }

  void step() {
    const Order order = program_.order;
    const bool by_particle = order == Order::kParticlesInPlace;
    const auto size = static_cast<std::size_t>(state_.cols());
    const std::size_t stages = slopes_.size();
    seen_ = state_;
    next_ = state_;
    if (order == Order::kForceAfterMove)
      seen_.topRows<2>() += program_.time_step * state_.bottomRows<2>();
    for (std::size_t n = 0; n < stages * size; ++n) {
      const std::size_t s = by_particle ? n % stages : n / size;
      const auto i = static_cast<Eigen::Index>(by_particle ? n / stages : n % size);
      slopes_[s].col(i) = slope(seen_, i);
      next_.col(i) = moved(i, s + 1);
      if (by_particle || order == Order::kStagesInPlace) seen_.col(i) = next_.col(i);
      if (order == Order::kPositionsInPlace) seen_.col(i).head<2>() = next_.col(i).head<2>();
      if (!by_particle && i + 1 == state_.cols()) std::swap(seen_, next_);
    }
    std::swap(state_, by_particle ? next_ : seen_);
  }

  Vectors accelerations(const Rows& z) const {
    Vectors result(2, z.cols());
    for (Eigen::Index i = 0; i < z.cols(); ++i) result.col(i) = slope(z, i).tail<2>();
    return result;
  }

  /// The change of the accelerations with a change of the state.
  Vectors changeOf(const Rows& z, const Rows& change) const {
    constexpr double kPart = 1e-4;
    return (accelerations(z + kPart * change) - accelerations(z - kPart * change)) / (2.0 * kPart);
  }

  static Eigen::VectorXd flat(const Vectors& vectors) {
    return Eigen::Map<const Eigen::VectorXd>(vectors.data(), vectors.size());
  }

  /// Newton's method for v' = v + h a(p + h v', v').
  void stepImplicitly() {
    constexpr int kMostIterations = 30;
    constexpr double kConverged = 1e-11;
    const double h = program_.time_step;
    const bool once = program_.implicit == Implicit::kOneIteration;
    const Vectors positions = state_.topRows<2>();
    const Vectors velocities = state_.bottomRows<2>();
    Rows way = Rows::Zero(4, state_.cols());
    way.topRows<2>() = h * velocities;
    if (!once) state_ += way;
    for (int n = 0; n < kMostIterations; ++n) {
      Vectors missing = velocities + h * accelerations(state_) - state_.bottomRows<2>();
      if (once) missing += h * changeOf(state_, way);
      const Eigen::VectorXd change = matrixOf(h).partialPivLu().solve(flat(missing));
      state_.bottomRows<2>() += Eigen::Map<const Vectors>(change.data(), 2, state_.cols());
      state_.topRows<2>() = positions + h * state_.bottomRows<2>();
      const double scale = 1.0 + velocities.abs().maxCoeff();
      if (once || !(change.cwiseAbs().maxCoeff() > kConverged * scale)) break;
    }
  }

  /// 1 - h da/dv - h² da/dp
  Eigen::MatrixXd matrixOf(double h) const {
    const Eigen::Index size = 2 * state_.cols();
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(size, size);
    for (Eigen::Index k = 0; k < size; ++k) {
      Rows way = Rows::Zero(4, state_.cols());
      way(k % 2, k / 2) = h;
      way(k % 2 + 2, k / 2) = 1.0;
      matrix.col(k) -= flat(h * changeOf(state_, way));
    }
    return matrix;
  }

  StudentProgram program_;
  std::int64_t first_frame_;
  Rows state_, seen_, next_;  ///< seen: what the forces are computed from
  std::vector<Rows> slopes_;  ///< by stage
  std::vector<StudentParticle> particles_;
  std::vector<double> start_lengths_;  ///< of the spring before each particle, m
  std::int64_t step_ = 0;
};

}  // namespace

std::unique_ptr<Motion> motionOf(const Method& method, const Scenario& scenario,
                                 const Scene& particles) {
  return std::make_unique<MethodMotion>(method, scenario, particles);
}

std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Scene& particles) {
  return std::make_unique<ProgramMotion>(program, particles);
}

}  // namespace spring_pendulum

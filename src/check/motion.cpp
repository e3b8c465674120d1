#include "check/motion.hpp"

#include "base/numbers.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

class MethodMotion : public Motion {
 public:
  MethodMotion(const Plan& plan, const Chain& chain, const Scene& particles)
      : Motion(plan, particles),
        integrator_(makeIntegrator(plan.method, chain, {plan.tolerance, false, 1})) {}

  bool advanceTo(std::int64_t frame, WorkLimit& limit) override {
    const std::int64_t steps = (frame - frame_) * plan_.steps();
    const double before = limit.done - integrator_->work();
    const auto stop = [&] {
      limit.done = before + integrator_->work();
      return limit.isOver();
    };
    State state(state_.cols());
    state.values() = state_.transpose().matrix();
    if (std::exchange(is_disturbed_, false)) integrator_->restart();
    if (integrator_->advance(state, plan_.step(), steps, stop) < steps) return false;
    limit.done = before + integrator_->work();
    state_ = state.values().transpose().array();
    frame_ = frame;
    return true;
  }

 private:
  std::unique_ptr<Integrator> integrator_;
};

class ProgramMotion : public Motion {
  using Vector = Eigen::Array2d;
  using Vectors = Eigen::Array2Xd;  ///< by particle
  using Row = Eigen::Array4d;       ///< x, y, vx, vy
  using Rows = Eigen::Array4Xd;     ///< by particle
  using Order = StudentProgram::Order;

 public:
  ProgramMotion(const StudentProgram& program, const Scene& particles)
      : Motion(program, particles), program_(program) {
    if (program.single_precision) {
      state_ = state_.cast<float>().cast<double>().eval();
      precision_ = std::numeric_limits<float>::epsilon();
    }
    // A mistake must explain the frames clearly better than rounding errors do, also in more steps.
    const double more = static_cast<double>(plan_.steps()) / program.right_steps;
    if (!program.mistakes.empty()) share_ = 0.5 / std::sqrt(std::max(1.0, more));
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
    constexpr double kWorkOfSpring = 2.5e-8;  // s, ten times that of a kernel of the library
    const std::int64_t target = std::max<std::int64_t>(
        0, program_.first_step + (frame - frame_) * program_.steps_per_frame);
    const bool is_implicit = (program_.kinds & StudentProgram::kImplicit) != 0;
    const auto size = static_cast<double>(state_.cols());
    const double springs = size * (is_implicit ? (20.0 + 0.3 * size) * size : 1.0);
    limit.done += static_cast<double>(target - step_) * kWorkOfSpring * springs *
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

 private:
  /// The force on particle i of the spring to its neighbour j.
  Vector springForce(const Rows& z, Eigen::Index i, Eigen::Index j) const {
    const Row difference = z.col(j) - z.col(i);
    const Vector separation = difference.head<2>();
    const double start_length = start_lengths_[static_cast<std::size_t>(std::max(i, j))];
    StudentSpring spring{
        separation,   difference.tail<2>(),        z.col(i).tail<2>(),        j < i,
        start_length, program_.spring.rest_length, separation.matrix().norm()};
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
    if (particles_[static_cast<std::size_t>(i)].moves)
      for (const auto change_move : program_.moves) change_move(move);
    return move.result;
  }

  void step() {
    const Order order = program_.order;
    const bool by_particle = order == Order::kParticlesInPlace;
    const auto size = static_cast<std::size_t>(state_.cols());
    const std::size_t stages = slopes_.size();
    seen_ = next_ = state_;
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

  /// Newton's method for v' = v + h a(p + h v', v').
  void stepImplicitly() {
    constexpr int kMostIterations = 30;
    constexpr double kConverged = 1e-11;
    constexpr double kChange = 1e-6;  // m/s, for the derivatives
    constexpr double kPart = 1e-4;    // of the change in a step, for linear forces
    const double h = program_.time_step;
    const Rows begin = state_;
    const auto missing = [&](const Eigen::VectorXd& v) -> Eigen::VectorXd {
      const Eigen::Map<const Vectors> velocities(v.data(), 2, begin.cols());
      state_ << begin.topRows<2>() + h * velocities, velocities;
      const Rows part = kPart * (state_ - begin);
      const Vectors a =
          !program_.is_linearised
              ? accelerations(state_)
              : accelerations(begin) +
                    (accelerations(begin + part) - accelerations(begin - part)) / (2.0 * kPart);
      const Vectors difference = begin.bottomRows<2>() + h * a - velocities;
      return Eigen::Map<const Eigen::VectorXd>(difference.data(), v.size());
    };
    const Vectors velocities = begin.bottomRows<2>();
    Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(velocities.data(), velocities.size());
    for (int n = 0; n < kMostIterations; ++n) {
      const Eigen::VectorXd error = missing(v);
      Eigen::MatrixXd matrix(v.size(), v.size());
      for (Eigen::Index k = 0; k < v.size(); ++k)
        matrix.col(k) =
            (error - missing(v + kChange * Eigen::VectorXd::Unit(v.size(), k))) / kChange;
      const Eigen::VectorXd change = matrix.partialPivLu().solve(error);
      v += change;
      if (!(change.cwiseAbs().maxCoeff() > kConverged * (1.0 + v.cwiseAbs().maxCoeff()))) break;
    }
    missing(v);
  }

  StudentProgram program_;
  Rows seen_, next_;          ///< seen: what the forces are computed from
  std::vector<Rows> slopes_;  ///< by stage
  std::vector<StudentParticle> particles_;
  std::vector<double> start_lengths_;  ///< of the spring before each particle, m
  std::int64_t step_ = 0;
};

/// The first particle of a frame that differs from a motion by more than a unit of the last digit and
/// `error` m. Printing changes no number by more than `scale`, the largest one.
std::optional<Departure> departureOf(const FrameNumbers& frame, const Eigen::ArrayX2d& motion,
                                     double scale, double error) {
  const auto agrees = ((frame.positions - motion).abs() <= frame.units.min(scale) + error) ||
                      (!frame.positions.isFinite() && !motion.isFinite());
  for (Eigen::Index i = 0; i < motion.rows(); ++i) {
    if (agrees.row(i).all()) continue;
    const Eigen::Array<double, 1, 2> all = frame.positions.row(i) - motion.row(i);
    const auto is_shown = all.abs() > frame.units.row(i).min(scale) || all.isNaN();
    const Eigen::RowVector2d offset = is_shown.select(all, 0.0);
    const double distance = std::hypot(offset.x(), offset.y());
    const std::string how = std::isfinite(distance) ? "by " + roundedText(distance, 2) + " m"
                                                    : "where a number is nan, inf or too large";
    return Departure{frame.index, distance, fmt::format("particle {}, {}", i + 1, how)};
  }
  return std::nullopt;
}

}  // namespace

Motion::Motion(const Plan& plan, const Scene& particles)
    : plan_(plan), frame_(particles.frame), state_(particles.state.values().transpose().array()) {
  if (kindOf(plan.method) == StudentProgram::kImplicit) precision_ = 1e-9;  // of iterations
}

void Motion::disturb(std::mt19937& random, bool off_line) {
  // Errors of a step in units of the last digit; measured: at most 3 in other orders of summation.
  constexpr double kRoundingErrors = 16.0;
  const double size = kRoundingErrors * std::sqrt(static_cast<double>(plan_.steps())) * precision_;
  for (Eigen::Index row = 0; row < state_.rows(); ++row) {
    auto numbers = state_.row(row);
    // Nothing if all are equal, like x in a vertical chain: their differences are exact.
    if (!off_line && numbers.minCoeff() == numbers.maxCoeff()) continue;
    const double error =
        0.1 * tolerance() + size * (off_line ? state_.abs().maxCoeff() : numbers.abs().maxCoeff());
    for (Eigen::Index i = 1; i < numbers.size(); ++i)
      numbers[i] += (2.0 * static_cast<double>(random()) / std::mt19937::max() - 1.0) * error;
  }
  is_disturbed_ = true;
}

std::unique_ptr<Motion> motionOf(const Plan& plan, const Chain& chain, const Scene& particles) {
  return std::make_unique<MethodMotion>(plan, chain, particles);
}

std::unique_ptr<Motion> motionOf(const StudentProgram& program, const Scene& particles) {
  return std::make_unique<ProgramMotion>(program, particles);
}

Agreement compare(const AllFrames& frames, const std::function<std::unique_ptr<Motion>()>& make,
                  WorkLimit& limit, bool off_line) {
  constexpr double kLargest = 1e18;  // m, beyond which squares are infinite in float
  std::mt19937 random(1);            // the same on every machine
  const auto motion = make();
  // One alone may hardly move in the direction in which errors grow.
  const std::array companions{make(), make()};
  for (const auto& companion : companions) companion->disturb(random, off_line);
  Agreement agreement;
  double rounding = 0.0, scale = 0.0, extent = 0.0;  // m: errors, largest coordinate and offset
  std::int64_t index = frames.start;
  for (auto frame = frames.frames.begin(); frame != frames.frames.end(); ++index) {
    if (limit.isOver() || !motion->advanceTo(index, limit)) break;
    limit.done += 1e-7 * static_cast<double>(frame->positions.size());  // s, to compare the numbers
    const Eigen::ArrayX2d positions = motion->positions();
    const Eigen::ArrayX2d offsets = (positions.rowwise() - positions.row(0)).abs();
    scale = std::max(scale, positions.isFinite().select(positions.abs(), 0.0).maxCoeff());
    extent = std::max(extent, offsets.isFinite().select(offsets, 0.0).maxCoeff());
    for (const auto& companion : companions) {
      if (!companion->advanceTo(index, limit)) break;
      const Eigen::ArrayX2d spread = (positions - companion->positions()).abs();
      rounding = spread.allFinite() ? std::max(rounding, spread.maxCoeff()) : INFINITY;
      if (motion->tolerance() == 0.0) companion->disturb(random, off_line);
    }
    const double most = std::min(1e-3 * scale, 0.03 * extent);  // beyond, nothing can be said
    if (limit.isOver() || !(rounding <= most) || scale > kLargest) break;
    if (index < frame->index) continue;  // missing
    const double error = motion->share() * rounding + motion->tolerance();
    agreement.departure = departureOf(*frame, positions, scale, error);
    // Programs that use angles leave a straight line: cos(π/2) is no 0, also in particle files.
    const bool is_line = offsets.colwise().maxCoeff().minCoeff() <= 1e-5 * extent;
    if (agreement.departure)
      return is_line && !off_line ? compare(frames, make, limit, true) : agreement;
    ++agreement.frames;
    agreement.roundings.push_back(rounding);
    agreement.last_frame = index;
    ++frame;
  }
  agreement.complete = agreement.frames > 0 && !limit.isStopped();
  return agreement;
}

}  // namespace spring_pendulum

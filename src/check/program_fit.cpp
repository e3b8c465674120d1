#include "check/program_fit.hpp"

#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace spring_pendulum {
namespace {

/// The differences between frames and motion as a function of the constants, for Eigen's MINPACK.
struct Differences {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  // NOLINTNEXTLINE(readability-identifier-naming): names that Eigen asks for
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  StudentProgram* program;
  const std::vector<const Constant*>* constants;
  const AllFrames* frames;
  Eigen::Index window;
  const Particles* particles;
  WorkLimit* limit;

  Eigen::Index inputs() const { return static_cast<Eigen::Index>(constants->size()); }
  Eigen::Index values() const {
    return window * 2 * static_cast<Eigen::Index>(particles->state.size());
  }

  void setConstants(const Eigen::VectorXd& numbers) const {
    for (std::size_t i = 0; i < constants->size(); ++i)
      (*constants)[i]->of(*program) = numbers[static_cast<Eigen::Index>(i)];
  }

  /// In units of the last digit printed.
  int operator()(const Eigen::VectorXd& numbers, Eigen::VectorXd& differences) const {
    constexpr double kRounding = 1e-12;  // relative; weighs tiny numbers with many digits less
    constexpr double kDiverged = 1e12;
    setConstants(numbers);
    const auto motion = motionOf(*program, *particles);
    Eigen::ArrayX2d positions;
    Eigen::Index row = 0;
    for (Eigen::Index n = 0; n < window; ++n) {
      const FrameNumbers& frame = frames->frames[static_cast<std::size_t>(n)];
      if (!motion->advanceTo(frame.index, *limit)) return -1;  // ends the fit
      motion->writePositions(positions);
      const Eigen::ArrayX2d difference =
          (positions - frame.positions) /
          (frame.units + kRounding * frame.positions.abs().maxCoeff());
      Eigen::Map<Eigen::ArrayX2d>(differences.data() + row, difference.rows(), 2) =
          difference.isFinite().select(difference, kDiverged);
      row += difference.size();
    }
    return 0;
  }
};

}  // namespace

void fitConstants(StudentProgram& program, const std::vector<const Constant*>& constants,
                  const AllFrames& frames, std::size_t window, const Particles& particles,
                  WorkLimit& limit) {
  constexpr int kMostEvaluations = 60;
  const Differences differences{&program,   &constants, &frames, static_cast<Eigen::Index>(window),
                                &particles, &limit};
  Eigen::NumericalDiff<Differences> with_slopes(differences);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Differences>> solver(with_slopes);
  solver.parameters.maxfev = kMostEvaluations;
  Eigen::VectorXd numbers(differences.inputs());
  for (std::size_t i = 0; i < constants.size(); ++i)
    numbers[static_cast<Eigen::Index>(i)] = constants[i]->of(program);
  if (differences.values() < differences.inputs()) return;
  solver.minimize(numbers);
  differences.setConstants(numbers);
}

}  // namespace spring_pendulum

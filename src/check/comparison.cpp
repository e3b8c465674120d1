#include "check/comparison.hpp"

#include <limits>
#include <random>

namespace spring_pendulum {
namespace {

/// Rounding errors above this share of the largest coordinate end a comparison.
constexpr double kComparable = 1e-3;

double largestFinite(const Eigen::ArrayX2d& numbers) {
  return numbers.isFinite().select(numbers.abs(), 0.0).maxCoeff();
}

/// NaN if one of the numbers is not finite.
double largestDistance(const Eigen::ArrayX2d& a, const Eigen::ArrayX2d& b) {
  const Eigen::ArrayX2d distance = (a - b).abs();
  return distance.allFinite() ? distance.maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

/// The first particle of a frame that differs from a motion by more than a unit of the last digit and
/// `rounding` m.
std::optional<Departure> departureOf(const FrameNumbers& frame, const Eigen::ArrayX2d& motion,
                                     double rounding) {
  const auto agrees = ((frame.positions - motion).abs() <= frame.units + rounding) ||
                      (!frame.positions.isFinite() && !motion.isFinite());
  for (Eigen::Index i = 0; i < motion.rows(); ++i) {
    if (agrees.row(i).all()) continue;
    return Departure{frame.index, 0.0, i + 1,
                     (frame.positions.row(i) - motion.row(i)).matrix().norm()};
  }
  return std::nullopt;
}

}  // namespace

Agreement compare(const AllFrames& frames, const MotionMaker& make, WorkLimit& limit) {
  const std::unique_ptr<Motion> motion = make();
  const std::unique_ptr<Motion> companion = make();
  std::mt19937 random(1);  // the same on every machine
  Agreement agreement;
  Eigen::ArrayX2d positions, disturbed;
  double rounding = 0.0;  // m
  companion->disturb(random);
  std::int64_t index = 0;
  for (auto frame = frames.frames.begin(); frame != frames.frames.end(); ++index) {
    if (limit.isOver()) break;
    if (!motion->advanceTo(index, limit) || !companion->advanceTo(index, limit)) break;
    motion->writePositions(positions);
    companion->writePositions(disturbed);
    const double spread = largestDistance(positions, disturbed);
    const double scale = std::max(agreement.scale, largestFinite(positions));
    rounding = spread <= rounding ? rounding : spread;  // NaN replaces it
    if (!(rounding <= kComparable * scale) && scale > 0.0) break;
    if (!companion->isDisturbedOnce()) companion->disturb(random);
    if (index < frame->index) continue;  // missing
    agreement.departure = departureOf(*frame, positions, rounding);
    if (agreement.departure) return agreement;
    ++agreement.frames;
    agreement.last_frame = index;
    agreement.scale = scale;
    agreement.distance = std::max(
        agreement.distance, (frame->positions - positions).matrix().rowwise().norm().maxCoeff());
    ++frame;
  }
  agreement.complete = agreement.frames > 0 && !limit.isStopped();
  return agreement;
}

}  // namespace spring_pendulum

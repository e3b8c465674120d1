#include "check/comparison.hpp"

#include <spring_pendulum/model/energy.hpp>

#include <algorithm>
#include <limits>
#include <random>

namespace spring_pendulum {
namespace {

double largestFinite(const Eigen::ArrayX2d& numbers) {
  return numbers.isFinite().select(numbers.abs(), 0.0).maxCoeff();
}

/// NaN if one of the numbers is not finite.
double largestDistance(const Eigen::ArrayX2d& a, const Eigen::ArrayX2d& b) {
  const Eigen::ArrayX2d distance = (a - b).abs();
  return distance.allFinite() ? distance.maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

/// The first particle of a frame that differs from a motion by more than a unit of the last digit and
/// `error` m.
std::optional<Departure> departureOf(const FrameNumbers& frame, const Eigen::ArrayX2d& motion,
                                     double error) {
  const auto agrees = ((frame.positions - motion).abs() <= frame.units + error) ||
                      (!frame.positions.isFinite() && !motion.isFinite());
  for (Eigen::Index i = 0; i < motion.rows(); ++i) {
    if (agrees.row(i).all()) continue;
    const Eigen::RowVector2d offset = (frame.positions.row(i) - motion.row(i)).matrix();
    Departure departure{frame.index, i + 1, offset.norm()};
    if (i > 0) {
      const Eigen::RowVector2d spring = (motion.row(i) - motion.row(i - 1)).matrix();
      departure.along_spring = std::abs(offset.dot(spring)) / (offset.norm() * spring.norm());
    }
    return departure;
  }
  return std::nullopt;
}

/// The potential energies of a motion, J.
class EnergyRange {
 public:
  explicit EnergyRange(const Chain& chain) : chain_(chain) {}

  void add(const Eigen::ArrayX2d& positions) {
    const double energy = of(positions);
    least_ = std::min(least_, energy);
    most_ = std::max(most_, energy);
  }
  /// What no frame of the motion can have; empty if nothing.
  std::string impossibleIn(const Eigen::ArrayX2d& positions) const {
    constexpr double kMargin = 1.1;
    if (!positions.allFinite()) return "has a number that is not finite";
    const bool is_possible = of(positions) <= least_ + kMargin * (most_ - least_);
    return is_possible ? "" : "has more energy than any frame before";
  }

 private:
  double of(const Eigen::ArrayX2d& positions) const {
    State state(chain_.size());
    state.positions() = positions.matrix();
    return computeEnergy(chain_, state).total();
  }

  const Chain& chain_;
  double least_ = std::numeric_limits<double>::infinity();
  double most_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

Agreement compare(const AllFrames& frames, const MotionMaker& make, WorkLimit& limit,
                  const Chain* chain) {
  constexpr double kComparable = 1e-3;  // more rounding errors end a comparison; of the scale
  const std::unique_ptr<Motion> motion = make();
  const std::unique_ptr<Motion> companion = make();
  std::optional<EnergyRange> energies;
  if (chain != nullptr) energies.emplace(*chain);
  std::mt19937 random(1);  // the same on every machine
  Agreement agreement;
  bool is_comparable = true;
  double rounding = 0.0;  // m
  double scale = 0.0;     // largest coordinate, m
  companion->disturb(random);
  std::int64_t index = frames.start;
  for (auto frame = frames.frames.begin(); frame != frames.frames.end(); ++index) {
    if (limit.isOver() || !motion->advanceTo(index, limit)) break;
    const Eigen::ArrayX2d positions = motion->positions();
    if (energies && positions.allFinite()) energies->add(positions);
    if (is_comparable) {
      if (!companion->advanceTo(index, limit)) break;
      const double spread = largestDistance(positions, companion->positions());
      rounding = spread <= rounding ? rounding : spread;  // NaN replaces it
      scale = std::max(scale, largestFinite(positions));
      is_comparable = rounding <= kComparable * scale || scale == 0.0;
      if (motion->tolerance() == 0.0) companion->disturb(random);
    }
    if (!is_comparable && !energies) break;
    if (index < frame->index) continue;  // missing
    if (is_comparable) {
      agreement.departure = departureOf(*frame, positions, rounding + motion->tolerance());
      if (agreement.departure) return agreement;
      ++agreement.frames;
      agreement.last_frame = index;
    } else if (positions.allFinite()) {
      const std::string impossible = energies->impossibleIn(frame->positions);
      if (!impossible.empty()) {
        agreement.departure = Departure{index, 0, 0.0, -1.0, impossible};
        return agreement;
      }
    }
    ++frame;
  }
  agreement.complete = agreement.frames > 0 && !limit.isStopped();
  return agreement;
}

}  // namespace spring_pendulum

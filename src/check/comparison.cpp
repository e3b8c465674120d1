#include <spring_pendulum/model/energy.hpp>

#include <algorithm>
#include <limits>
#include <random>

#include "check/motion.hpp"

namespace spring_pendulum {
namespace {

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

/// Potential energy, J.
double energyOf(const Chain& chain, const Eigen::ArrayX2d& positions) {
  State state(chain.size());
  state.positions() = positions.matrix();
  return computeEnergy(chain, state).total();
}

/// What no frame of a motion between these potential energies can have; empty if nothing.
std::string impossibleIn(const Eigen::ArrayX2d& positions, const Chain& chain, double least,
                         double most) {
  constexpr double kMargin = 1.1;
  if (!positions.allFinite()) return "has a number that is not finite";
  const bool is_possible = energyOf(chain, positions) <= least + kMargin * (most - least);
  return is_possible ? "" : "has more energy than any frame before";
}

}  // namespace

Agreement compare(const AllFrames& frames, const MotionMaker& make, WorkLimit& limit,
                  const Chain* chain) {
  constexpr double kComparable = 1e-3;  // more rounding errors end a comparison; of the scale
  const std::unique_ptr<Motion> motion = make();
  const std::unique_ptr<Motion> companion = make();
  double least_energy = std::numeric_limits<double>::infinity();  // J
  double most_energy = -least_energy;
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
    if (chain != nullptr && positions.allFinite()) {
      least_energy = std::min(least_energy, energyOf(*chain, positions));
      most_energy = std::max(most_energy, energyOf(*chain, positions));
    }
    if (is_comparable) {
      if (!companion->advanceTo(index, limit)) break;
      const double spread = largestDistance(positions, companion->positions());
      rounding = spread <= rounding ? rounding : spread;  // NaN replaces it
      scale = std::max(scale, positions.isFinite().select(positions.abs(), 0.0).maxCoeff());
      is_comparable = rounding <= kComparable * scale || scale == 0.0;
      if (motion->tolerance() == 0.0) companion->disturb(random);
    }
    if (!is_comparable && chain == nullptr) break;
    if (index < frame->index) continue;  // missing
    if (is_comparable) {
      agreement.departure = departureOf(*frame, positions, rounding + motion->tolerance());
      if (agreement.departure) return agreement;
      ++agreement.frames;
      agreement.last_frame = index;
    } else if (positions.allFinite()) {
      const std::string impossible =
          impossibleIn(frame->positions, *chain, least_energy, most_energy);
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

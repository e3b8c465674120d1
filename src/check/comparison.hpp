// Compares frames with a motion. What counts as equal follows from the digits printed and from a
// companion of the motion: the same motion, disturbed by more rounding errors than there are.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "check/frame_numbers.hpp"
#include "check/motion.hpp"

namespace spring_pendulum {

struct Agreement {
  std::size_t frames = 0;              ///< leading frames that agree
  bool complete = false;               ///< whether all frames compared agree
  std::optional<Departure> departure;  ///< in the next frame; without its time
  std::int64_t last_frame = 0;         ///< index of the last frame that agrees
  double distance = 0.0;               ///< largest distance in these, m
  double scale = 0.0;                  ///< largest coordinate in these, m
};

using MotionMaker = std::function<std::unique_ptr<Motion>()>;

/// Compares until the first frame that differs, or until rounding errors have grown to a thousandth
/// of the size of the motion, after which nothing can be compared, or until the limit is reached.
Agreement compare(const AllFrames& frames, const MotionMaker& make, WorkLimit& limit);

}  // namespace spring_pendulum

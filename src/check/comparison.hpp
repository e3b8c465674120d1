// Compares frames with a motion. What counts as equal follows from the digits printed and from a
// companion of the motion: the same motion, disturbed by more rounding errors than there are.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "check/frames.hpp"
#include "check/motion.hpp"

namespace spring_pendulum {

/// Where frames depart from a motion.
struct Departure {
  std::int64_t frame = 0;
  std::ptrdiff_t particle = 0;  ///< the first one, counted from 1
  double distance = 0.0;        ///< m; NaN if the frame has a number that is not finite
  /// Share of the distance along the spring to the previous particle; -1 if there is none.
  double along_spring = -1.0;
  /// What is impossible in a frame that is too late to be compared; empty: it was compared.
  std::string impossible = {};
};

struct Agreement {
  std::size_t frames = 0;              ///< leading frames that agree
  bool complete = false;               ///< whether all frames that could be compared agree
  std::optional<Departure> departure;  ///< in a later frame
  std::int64_t last_frame = -1;        ///< index of the last frame that agrees
};

using MotionMaker = std::function<std::unique_ptr<Motion>()>;

/// Compares until the first frame that differs, or until rounding errors have grown to a thousandth
/// of the size of the motion, after which nothing can be compared, or until the limit is reached.
/// \param chain of the motion: later frames must be finite, and must not have much more potential energy
///   than any state of the motion before. Null: they are not looked at.
Agreement compare(const AllFrames& frames, const MotionMaker& make, WorkLimit& limit,
                  const Chain* chain = nullptr);

}  // namespace spring_pendulum

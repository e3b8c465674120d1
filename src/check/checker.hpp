// Finds out what is wrong with the frames of another program for the same exercise.
//
// The frames are compared with the methods of the table and, if they differ, with programs that make
// one or two known mistakes or have a wrong constant. Two numbers count as equal if they differ by no
// more than the digits printed and the rounding errors of the motion allow.
#pragma once

#include "io/files/frame_folder.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

/// By severity. Undecided: no difference, but the last frames are missing or cannot be compared.
enum class FrameVerdict { kEqual, kUndecided, kDifferent };

struct FrameCheck {
  FrameVerdict verdict;
  /// The verdict; for different frames where they depart, and the mistakes; notes.
  std::vector<std::string> lines;
  std::optional<double> departure_time = {};  ///< s
};

/// Compares frames with those of a right program that starts with `particles`.
/// \param scenario  constants of the model, steps, tolerance and number of frames of a right program
/// \param frames    in any order, some may be missing
/// \param method_is_given whether the frames must be those of `Scenario::method`. Otherwise they may be
///   those of any method but explicit Runge-Kutta methods of other courses.
/// \param stop      asked every few milliseconds; when it returns true, the check ends
/// \throws InputError for a value of the scenario out of its range
/// \throws FileError naming frame and line if there are no frames, or one of them can't be read or
///   has another number of particles, and if `stop` ends the check before a verdict
FrameCheck checkFrames(const Scenario& scenario, const Scene& particles,
                       std::vector<FrameText> frames, bool method_is_given,
                       const std::function<bool()>& stop = {});

}  // namespace spring_pendulum

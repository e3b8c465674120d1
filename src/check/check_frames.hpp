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

/// By severity.
enum class FrameVerdict {
  kEqual,
  kUndecided,  ///< no difference, but the last frames are missing or cannot be compared
  kDifferent
};

struct FrameCheck {
  FrameVerdict verdict = FrameVerdict::kUndecided;
  std::string result;                    ///< "different: Euler with no_damping"
  std::vector<std::string> details;      ///< where different frames depart, and the mistakes
  std::vector<std::string> notes;        ///< on missing frames, for example
  std::optional<double> departure_time;  ///< s
};

struct CheckOptions {
  /// Whether the frames must be those of `Scenario::method`. Otherwise any method is right.
  bool method_is_given = false;
  /// Asked every few milliseconds; when it returns true, the check ends.
  std::function<bool()> stop = {};
};

/// Adds methods that other courses ask for to the method table: Heun, Ralston.
void registerCourseMethods();

/// Checks frames.
/// \param scenario  the constants of the model, steps, tolerance and number of frames that the program
///   should have
/// \param particles the start
/// \param frames    in any order, some may be missing
/// \throws InputError for a value of the scenario out of its range
/// \throws FileError naming frame and line if there are no frames, or one of them can't be read or
///   has another number of particles, and if `CheckOptions::stop` ends the check before a verdict
FrameCheck checkFrames(const Scenario& scenario, const Scene& particles,
                       const std::vector<FrameText>& frames, const CheckOptions& options = {});

/// Returns the result, the details and the notes, each on a line of its own.
std::string reportOf(const FrameCheck& check);

/// Returns a line for each known mistake: its name and its sentence.
std::string listOfMistakes();

}  // namespace spring_pendulum

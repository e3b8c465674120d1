// Finds out what is wrong with the frames of another program for the same exercise.
//
// The frames are compared with the methods of the table and, if they differ, with programs that make
// one or two known mistakes or have a wrong constant. Two numbers count as equal if they differ by no
// more than the digits printed and the rounding errors of the motion allow.
#pragma once

#include "io/files/frame_folder_reader.hpp"
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "check/motion.hpp"
#include "check/search.hpp"

namespace spring_pendulum {

/// By severity.
enum class FrameVerdict {
  kEqual,
  kUndecided,  ///< no difference, but the last frames are missing or cannot be compared
  kDifferent
};

struct FrameCheck {
  FrameVerdict verdict = FrameVerdict::kUndecided;
  /// Method that the frames equal as far as they can be compared, best first. Not empty for different
  /// frames if they are those of another method than wanted.
  std::vector<std::string> methods;
  std::int64_t frames = 0;                ///< number of frames compared
  std::int64_t last_frame = -1;           ///< index of the last one that could be compared
  int digits = 0;                         ///< significant digits printed
  std::string nearest;                    ///< method that the frames follow longest
  std::optional<Departure> departure;     ///< from `nearest`
  double time = 0.0;                      ///< of the departure, s
  std::vector<Explanation> explanations;  ///< indistinguishable ones; empty: none found
  std::vector<std::string> remarks;       ///< one line each
  /// The result in one or two lines, without remarks.
  std::string text;
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

/// Returns the result and the remarks, each on a line of its own.
std::string reportOf(const FrameCheck& check);

/// Returns the result and the remarks on one line without details: "equal to Euler", "heun + g".
std::string shortReportOf(const FrameCheck& check);

/// Returns a JSON object on one line.
/// \param folder name of the frames
std::string jsonOf(const FrameCheck& check, const std::string& folder);

/// Returns a JSON object on one line for frames that can't be read.
std::string jsonOfError(const std::string& message, const std::string& folder);

/// Returns a line for each known mistake: its name and its sentence.
std::string listOfMistakes();

}  // namespace spring_pendulum

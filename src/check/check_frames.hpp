// Finds out what is wrong with the frames of another program for the same exercise.
//
// The frames are compared with the methods of the table and, if they differ, with programs that make
// a known mistake, constants that fit, or two of these. Two numbers count as equal if they differ by
// no more than the digits printed and the rounding errors of the motion allow; a companion of each
// run, disturbed by a few rounding errors in every frame, measures the latter.
#pragma once

#include "io/files/frame_folder_reader.hpp"
#include <spring_pendulum/model/particles.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {

/// Where frames depart from a motion.
struct Departure {
  std::int64_t frame = 0;
  double time = 0.0;            ///< s
  std::ptrdiff_t particle = 0;  ///< counted from 1
  double distance = 0.0;        ///< m; NaN if the frame has a number that is not finite
};

/// Mistakes that together reproduce the frames.
struct Explanation {
  std::string method;                 ///< the method in which they are made
  std::vector<std::string> mistakes;  ///< short names: "heun", "g"
  std::vector<std::string>
      sentences;                ///< for the student, one per mistake: "g is 10, not 9.81 m/s²"
  std::int64_t last_frame = 0;  ///< reproduced up to this frame
};

struct FrameCheck {
  bool equal = false;                  ///< whether the frames are right
  std::vector<std::string> methods;    ///< that the frames equal, best first; may be not empty if
                                       ///< they are not right: another method than wanted
  std::int64_t frames = 0;             ///< number of frames compared
  std::int64_t last_frame = 0;         ///< index of the last one that could be compared
  int digits = 0;                      ///< significant digits that agree
  int printed_digits = 0;              ///< significant digits in the frames
  std::string nearest;                 ///< method that the frames follow longest
  std::optional<Departure> departure;  ///< from `nearest`
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

/// Checks frames.
/// \param scenario  the constants of the model, steps and tolerance that the frames should have
/// \param particles the start
/// \param frames    in any order, some may be missing
/// \throws InputError for a value of the scenario out of its range
/// \throws FileError naming frame and line if there are no frames, or one of them can't be read or
///   has another number of particles, and if `CheckOptions::stop` ends the check before a verdict
FrameCheck checkFrames(const Scenario& scenario, const Particles& particles,
                       const std::vector<FrameText>& frames, const CheckOptions& options = {});

/// Returns the result and the remarks, each on a line of its own.
std::string reportOf(const FrameCheck& check);

/// Returns the result on one line without its details: "equal to Euler", "heun + g".
std::string shortReportOf(const FrameCheck& check);

/// Returns a JSON object on one line.
/// \param folder name of the frames
std::string jsonOf(const FrameCheck& check, const std::string& folder);

/// Returns a JSON object on one line for frames that can't be read.
std::string jsonOfError(const std::string& message, const std::string& folder);

/// Returns a line for each known mistake: its name and its sentence.
std::string listOfMistakes();

}  // namespace spring_pendulum

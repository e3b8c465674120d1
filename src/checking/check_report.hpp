// The result of a check for a terminal, for a program and for a table.
#pragma once

#include <spring_pendulum/checking/check_frames.hpp>

#include <string>

namespace spring_pendulum {

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

// Reads the frames in a folder, whoever wrote them.
#pragma once

#include <spring_pendulum/checking/check_frames.hpp>

#include <string>
#include <vector>

namespace spring_pendulum {

/// Returns the files frame_NNNN.txt of a folder, with any number of digits, by index.
/// \throws FileError naming folder or file if it can't be read, if there are no frames, or if they
///   are too long to be compared
std::vector<FrameText> readFrameFolder(const std::string& folder);

}  // namespace spring_pendulum

// Reads the frames in a folder, whoever wrote them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace spring_pendulum {

/// The text of one frame: a line `x y` per particle. Columns are separated by blanks or a comma.
struct FrameText {
  std::int64_t index = 0;  ///< NNNN of frame_NNNN.txt
  std::string name;        ///< for error messages: "frame_0007.txt"
  std::string text;
};

/// Returns the files frame_NNNN.txt of a folder, with any number of digits, by index.
/// \throws FileError naming folder or file if it can't be read, if there are no frames, or if they
///   are too long to be compared
std::vector<FrameText> readFrameFolder(const std::string& folder);

}  // namespace spring_pendulum

// Folders with frame files.
#pragma once

#include "io/files/output_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// Its hidden name is that of the empty file that locks a folder of frames.
constexpr const char* kFramesLock = "frames";

/// "frame_0042.txt"; indices above 9999 have more digits.
std::string frameName(std::int64_t index);

/// Whether this is the name of a frame file or of one that a killed run has not finished.
bool isFrameName(const std::string& name);

/// Removes the frames of an earlier run.
/// \param first number of the first frame to be written; frames before it stay
/// \returns the number of removed frames, without unfinished ones
/// \throws FileError naming the file, before any file is removed if one is not a regular file
std::int64_t removeFrames(const OutputFolder& folder, std::int64_t first);

/// The text of one frame: a line `x y` per particle. Columns are separated by blanks or a comma.
struct FrameText {
  std::int64_t index = 0;  ///< NNNN of frame_NNNN.txt
  std::string name;        ///< for error messages: "frame_0007.txt"
  std::string text;
};

/// Returns the files frame_NNNN.txt of a folder, with any number of digits, by index.
/// \throws FileError naming folder or file if it can't be read, or if there are no frames or too long ones
std::vector<FrameText> readFrameFolder(const std::string& folder);

}  // namespace spring_pendulum

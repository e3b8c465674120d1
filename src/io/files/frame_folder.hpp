// The folder with the frame files of a run.
#pragma once

#include "io/files/atomic_file.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// Its hidden name is that of the file that locks a folder of frames, which is always empty.
constexpr const char* kFramesLock = "frames";

/// "frame_0042.txt"; indices above 9999 have more digits.
std::string frameName(std::int64_t index);

/// Returns the index of a frame file: its name is `frame_` + at least four digits + `.txt`.
/// \param digits the least number of digits
std::optional<std::int64_t> frameIndex(std::string_view name, std::size_t digits = 4);

/// Whether this is the name of a frame file or of one that a killed run has not finished.
bool isFrameName(const std::string& name);

/// A folder that only this run writes frames into. Each frame file is complete or absent.
class FrameFolder {
 public:
  /// Creates the folder if needed, locks it, and removes the frames of an earlier run.
  /// \param first number of the first frame to be written; frames before it stay
  /// \throws FileError naming the folder or file
  FrameFolder(const std::string& folder, std::int64_t first);

  /// Begins a frame.
  /// \throws FileError naming the file
  AtomicFile begin(std::int64_t index) const;

  /// Releases the folder.
  /// \throws FileError if the path no longer leads to it
  void close();
  /// Absolute path.
  const std::string& path() const { return folder_.path(); }
  /// Number of removed frames of an earlier run.
  std::int64_t earlierFrames() const { return earlier_frames_; }

 private:
  void removeEarlier(std::int64_t first);

  OutputFolder folder_;
  AtomicFile lock_;  ///< never finished: it also shows that the folder is writable
  std::int64_t earlier_frames_ = 0;
};

}  // namespace spring_pendulum

// The folder with the frame files of a run.
#pragma once

#include "io/files/unfinished_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <vector>

namespace spring_pendulum {

/// "frame_0042.txt"; indices above 9999 have more digits.
std::string frameName(std::int64_t index);

/// Whether this is the name of a frame file, "frame_0042.txt", or of an unfinished one.
bool isFrameName(std::string_view name);

/// Locks the folder against a second run. If the program is stopped at any time, each frame file is
/// complete or absent: it is written under a hidden name, `.frame_0042.tmp`, and then renamed.
///
/// Frames of an earlier run are renamed to hidden names first. New frames overwrite these files, as
/// some file systems need milliseconds to free the blocks of a file and microseconds to overwrite it:
/// on ext4, a second run of the exercise took 6.9 times as long without this (median of 25 pairs). Files
/// of another user or with other permissions are not reused. `close` removes the files that are left.
class FrameFolder {
 public:
  /// Creates the folder if needed, checks that it is writable, and hides the frames of an earlier
  /// run: regular files named `frame_` + at least four digits + `.txt`.
  /// \param frames number of frames of the run
  /// \param first  number of the first frame to be written; frames before it stay
  /// \throws FileError naming the folder or file
  FrameFolder(const std::string& folder, std::int64_t frames, std::int64_t first = 0);
  ~FrameFolder();
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;

  /// Begins a frame, appends text to it, and ends it. The file appears in the folder at the end.
  /// \throws FileError naming the file
  void beginFrame(std::int64_t index);
  void write(const char* data, std::size_t size);
  void endFrame();
  /// Ends a frame of `length` bytes that other processes have written to `unfinishedPath`.
  void endFrame(std::int64_t length);
  /// Absolute path of the frame that was begun.
  std::string unfinishedPath() const { return path_ + "/" + file_.name(); }

  /// Removes the remaining files of an earlier run and unlocks the folder. No frame after this.
  /// \throws FileError if the path no longer leads to the folder
  void close();

  /// True until close().
  bool isOpen() const { return descriptor_.isOpen(); }

  /// Absolute path.
  const std::string& path() const { return path_; }
  /// Number of removed frames of an earlier run.
  std::int64_t earlierFrames() const { return earlier_frames_; }

 private:
  void open();
  std::vector<std::string> listOwnFiles(std::int64_t first) const;
  void tryOut();
  void takeAway(const std::vector<std::string>& earlier, std::int64_t frames);
  bool openHidden(std::int64_t index);
  void removeHidden();
  [[noreturn]] void refuse(const std::string& name, const std::string& reason) const;
  [[noreturn]] void refuseForErrno(const std::string& name) const;

  std::string given_path_;
  std::string path_;  ///< absolute
  FileDescriptor descriptor_;
  std::vector<std::string> old_files_;  ///< hidden, reused from the back
  std::int64_t earlier_frames_ = 0;
  struct stat fresh_ {};    ///< status of a new file in this folder
  UnfinishedFile file_;     ///< the current frame
  std::string frame_name_;  ///< final name of the current frame
};

}  // namespace spring_pendulum

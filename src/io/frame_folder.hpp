// The folder that holds the frame files of one run at a time.
#pragma once

#include "io/file_descriptor.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace spring_pendulum {

/// "frame_0042.txt"; above 9999 the index grows wider.
std::string frameName(std::int64_t index);

/// Locked against a second run as long as this lives. A file in it is whole or absent, whenever the
/// program is stopped: it is written under a hidden name, `.frame_0042.tmp`, and then renamed.
///
/// Frames of an earlier run vanish at once, under hidden names too, but their files are written
/// again for the new frames: some file systems need milliseconds to give the blocks of one file
/// free (measured: ext4 with online discard 3.6 ms, once a file has reached the disk) and
/// microseconds to write it again. What is not needed again is removed.
class FrameFolder {
 public:
  /// Makes the folder if it is absent, makes sure that it can be written, and takes the frames of
  /// an earlier run away: regular files named `frame_` + at least four digits + `.txt`.
  /// \param frames how many frames are going to be written
  /// \throws FileError naming the folder or file
  FrameFolder(const std::string& folder, std::int64_t frames);
  ~FrameFolder();
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;

  /// A frame is begun, written piece by piece and ended, when it appears in the folder.
  /// \throws FileError naming the file
  void beginFrame(std::int64_t index);
  void write(const char* data, std::size_t size);
  void endFrame();

  /// Removes what is left of an earlier run and unlocks the folder. No frame after this.
  void close();

  /// Absolute path.
  const std::string& path() const { return path_; }

 private:
  void open();
  void checkIsWritable();
  void takeEarlierFramesAway(std::int64_t frames);
  std::vector<std::string> listOwnFiles() const;
  FileDescriptor openHidden(std::int64_t index);
  void removeHidden();
  [[noreturn]] void refuse(const std::string& name, const std::string& reason) const;
  [[noreturn]] void refuseForErrno(const std::string& name) const;

  std::string path_;
  FileDescriptor descriptor_;
  std::vector<std::string> old_files_;  ///< hidden, to be written again from the back
  FileDescriptor file_;                 ///< that is being written
  std::string hidden_name_;             ///< of this file
  std::string frame_name_;              ///< that it is going to have
  std::int64_t length_ = 0;             ///< written to it so far, bytes
};

}  // namespace spring_pendulum

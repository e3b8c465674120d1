// The folder that holds the frame files of one run at a time.
#pragma once

#include "io/unfinished_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <vector>

namespace spring_pendulum {

/// "frame_0042.txt"; above 9999 the index grows wider.
std::string frameName(std::int64_t index);

/// Whether a file of this name in a folder of frames belongs to them: "frame_0042.txt", or the name
/// it has until it is whole.
bool isFrameName(std::string_view name);

/// Locked against a second run as long as this lives. A file in it is whole or absent, whenever the
/// program is stopped: it is written under a hidden name, `.frame_0042.tmp`, and then renamed.
///
/// Frames of an earlier run vanish at once, under hidden names too, but their files are written
/// again for the new frames, unless another user owns them or they have other permissions than a
/// new file: some file systems need milliseconds to give the blocks of one file
/// free (measured: ext4 with online discard 3.6 ms, once a file has reached the disk) and
/// microseconds to write it again. What is not needed again is removed.
class FrameFolder {
 public:
  /// Makes the folder if it is absent, makes sure that it can be written, and takes the frames of
  /// an earlier run away: regular files named `frame_` + at least four digits + `.txt`.
  /// \param frames how many frames are going to be written
  /// \param inputs files that the run reads, which must not be taken away
  /// \throws InputError if one of the inputs has the name of a frame in this folder
  /// \throws FileError naming the folder or file
  FrameFolder(const std::string& folder, std::int64_t frames,
              const std::vector<std::string>& inputs = {});
  ~FrameFolder();
  FrameFolder(const FrameFolder&) = delete;
  FrameFolder& operator=(const FrameFolder&) = delete;

  /// A frame is begun, written piece by piece and ended, when it appears in the folder.
  /// \throws FileError naming the file
  void beginFrame(std::int64_t index);
  void write(const char* data, std::size_t size);
  void endFrame();

  /// Removes what is left of an earlier run and unlocks the folder. No frame after this.
  /// \throws FileError if the path does not lead to the folder any more
  void close();

  /// Until close().
  bool isOpen() const { return descriptor_.isOpen(); }

  /// The whole path.
  const std::string& path() const { return path_; }
  /// How many frames of an earlier run were taken away.
  std::int64_t earlierFrames() const { return earlier_frames_; }

 private:
  void open();
  std::vector<std::string> listOwnFiles(const std::vector<std::string>& inputs) const;
  void tryOut();
  void takeAway(const std::vector<std::string>& earlier, std::int64_t frames);
  bool openHidden(std::int64_t index);
  void removeHidden();
  [[noreturn]] void refuse(const std::string& name, const std::string& reason) const;
  [[noreturn]] void refuseForErrno(const std::string& name) const;

  std::string given_path_;
  std::string path_;  ///< as it is shown
  FileDescriptor descriptor_;
  std::vector<std::string> old_files_;  ///< hidden, to be written again from the back
  std::int64_t earlier_frames_ = 0;
  struct stat fresh_ {};    ///< what a new file in this folder is like
  UnfinishedFile file_;     ///< that is being written
  std::string frame_name_;  ///< that it is going to have
};

}  // namespace spring_pendulum

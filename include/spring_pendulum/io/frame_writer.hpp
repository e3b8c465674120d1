// Frame files: the positions of the particles at the times t = 0, T, 2T, ...
//
// The files `frame_0000.txt`, `frame_0001.txt`, ... have a line `x y` (m) for each particle. Every
// number is the shortest text that reads back as the same double. Indices above 9999 have more
// digits.
#pragma once

#include <spring_pendulum/model/state.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

class FrameFolder;

/// Writes the frames of a run into a folder. If the program is stopped at any time, each frame file
/// is either complete or absent. The folder is locked against a second writer.
class FrameWriter {
 public:
  /// Creates the folder if needed, checks that it is writable, and removes the frames of an earlier
  /// run: regular files named `frame_` + at least four digits + `.txt`, nothing else.
  /// \param frames number of frames of the run
  /// \param inputs input files of the run, which are never removed
  /// \param first  number of the first frame to be written; earlier frames before it stay
  /// \throws InputError if one of the inputs has the name of a frame in this folder, or `frames` is
  ///         negative
  /// \throws FileError naming the folder or file
  FrameWriter(const std::string& folder, std::int64_t frames,
              const std::vector<std::string>& inputs = {}, std::int64_t first = 0);
  FrameWriter(FrameWriter&&) noexcept;
  ~FrameWriter();

  /// Writes frame `index`, 0 <= index < frames.
  /// \throws InputError for another index, after finish(), or if the writer was moved from
  /// \throws FileError naming the file
  void write(std::int64_t index, const State& state);

  /// Ends the run and releases the folder. `write` must not be called after this. A second call
  /// does nothing.
  /// \throws FileError if the folder was moved away during the run
  void finish();

  /// Absolute path of the folder.
  const std::string& folder() const;
  /// Number of removed frames of an earlier run.
  std::int64_t earlierFrames() const;
  /// Wall-clock time spent in this class, s.
  double seconds() const { return seconds_; }

 private:
  FrameFolder& frameFolder() const;

  double seconds_ = 0.0;
  std::int64_t frames_;
  std::unique_ptr<FrameFolder> folder_;
  std::vector<char> text_;  ///< buffer for the lines of a frame
};

}  // namespace spring_pendulum
#pragma GCC visibility pop

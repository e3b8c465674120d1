// Frame files that are formatted and written while the next frame is computed.
#pragma once

#include <spring_pendulum/io/frame_writer.hpp>

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace spring_pendulum {

/// Writes what a `FrameWriter` writes, in the same order, but on a thread of its own if the frames
/// are large enough to gain from it. One frame waits or is written at a time; who hands over the
/// next one waits for it.
class BackgroundFrameWriter {
 public:
  /// From so many particles on to hand a frame over takes far less than to format it.
  static constexpr Eigen::Index kLargeFrame = 1000;

  /// As FrameWriter.
  BackgroundFrameWriter(const std::string& folder, std::int64_t frames,
                        const std::vector<std::string>& inputs = {});
  /// A frame that was handed over is still written.
  ~BackgroundFrameWriter();
  BackgroundFrameWriter(const BackgroundFrameWriter&) = delete;
  BackgroundFrameWriter& operator=(const BackgroundFrameWriter&) = delete;

  /// As FrameWriter. All frames are of the same size.
  /// \throws FileError naming the file, also that of the frame before; then no more is written
  void write(std::int64_t index, const State& state);

  /// As FrameWriter, when all frames are written.
  /// \throws FileError naming the file, also that of the last frame
  void finish();

  /// Absolute path of the folder.
  std::string folder() const { return writer_.folder(); }
  /// As FrameWriter.
  std::int64_t earlierFrames() const { return writer_.earlierFrames(); }
  /// Wall-clock time that callers of `write` spent in it, s.
  double secondsWaited() const { return seconds_waited_; }
  /// Wall-clock time spent formatting and writing, on whichever thread, s. Only after `finish`.
  double secondsWriting() const { return writer_.seconds(); }

 private:
  void work();
  void start();
  void handOver(std::int64_t index, const State& state);
  void stop();

  FrameWriter writer_;
  double seconds_waited_ = 0.0;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_frame_ = false;  ///< `index_` and `state_` wait to be written, or are being
  bool stop_ = false;
  std::exception_ptr error_;
  std::int64_t index_ = 0;
  State state_;
  std::thread thread_;
};

}  // namespace spring_pendulum

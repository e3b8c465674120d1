#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "base/stopwatch.hpp"
#include "io/files/frame_folder.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/frame_writer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr std::size_t kLongestLine = 2 * (kLongestNumber + 1);
constexpr Eigen::Index kLinesAtOnce = 4096;
/// Copying a frame of more particles takes far less time than formatting it.
constexpr Eigen::Index kLargeFrame = 1000;

}  // namespace

class FrameWriter::Writer {
 public:
  Writer(const std::string& folder, std::int64_t frames, std::int64_t first) : frames_(frames) {
    requireAtLeastZero("frames", frames);
    const Stopwatch stopwatch(seconds);
    folder_.emplace(folder, first);
    path = folder_->path();
    earlier_frames = folder_->earlierFrames();
  }
  ~Writer() { stop(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void write(std::int64_t index, const State& state);
  void finish();

  std::string path;
  std::int64_t earlier_frames = 0;
  double seconds = 0.0;

 private:
  void startThread();
  void handOver(std::int64_t index, const State& state);
  void work();
  void stop();
  void writeNow(std::int64_t index, const State& state);

  std::int64_t frames_;
  std::optional<FrameFolder> folder_;
  std::vector<char> text_;  ///< buffer for some lines of a frame

  std::mutex mutex_;
  std::condition_variable changed_;
  bool has_frame_ = false;  ///< whether `index_` and `state_` are still to be written
  bool stop_ = false;
  std::exception_ptr error_;
  std::int64_t index_ = 0;
  State state_;
  std::thread thread_;
};

void FrameWriter::Writer::write(std::int64_t index, const State& state) {
  if (!folder_) throw InputError("the frame writer has finished");
  if (index < 0 || index >= frames_) {
    throw InputError(fmt::format("frame {}: must be 0 to {}", index, frames_ - 1));
  }
  const bool gains = state.size() >= kLargeFrame && std::thread::hardware_concurrency() > 1;
  if (gains && !thread_.joinable()) startThread();
  if (thread_.joinable()) {
    handOver(index, state);
  } else {
    writeNow(index, state);
  }
}

void FrameWriter::Writer::startThread() {
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error&) {  // the system refuses a thread: write in this one
  }
}

void FrameWriter::Writer::handOver(std::int64_t index, const State& state) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !has_frame_; });
  if (error_) std::rethrow_exception(error_);
  index_ = index;
  state_ = state;
  has_frame_ = true;
  changed_.notify_all();
}

void FrameWriter::Writer::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return has_frame_ || stop_; });
    if (!has_frame_) return;
    lock.unlock();
    std::exception_ptr error;
    try {
      writeNow(index_, state_);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    error_ = error;
    has_frame_ = false;
    changed_.notify_all();
  }
}

void FrameWriter::Writer::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameWriter::Writer::finish() {
  stop();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  const Stopwatch stopwatch(seconds);
  if (folder_) folder_->checkPath();
  folder_.reset();
}

void FrameWriter::Writer::writeNow(std::int64_t index, const State& state) {
  const Stopwatch stopwatch(seconds);
  const Eigen::Index size = state.size();
  const double* const x = state.x().data();
  const double* const y = state.y().data();
  text_.resize(static_cast<std::size_t>(std::min(size, kLinesAtOnce)) * kLongestLine);
  AtomicFile file = folder_->begin(index);
  for (Eigen::Index first = 0; first < size; first += kLinesAtOnce) {
    char* end = text_.data();
    for (Eigen::Index i = first; i < std::min(size, first + kLinesAtOnce); ++i) {
      end = writeLine({x[i], y[i]}, end);
    }
    file.write({text_.data(), static_cast<std::size_t>(end - text_.data())});
  }
  file.finish();
}

FrameWriter::FrameWriter(const std::string& folder, std::int64_t frames, std::int64_t first)
    : writer_(std::make_unique<Writer>(folder, frames, first)) {}

FrameWriter::FrameWriter(FrameWriter&&) noexcept = default;
FrameWriter::~FrameWriter() = default;

FrameWriter::Writer& FrameWriter::writer() const {
  if (!writer_) throw InputError("the frame writer was moved from");
  return *writer_;
}

void FrameWriter::write(std::int64_t index, const State& state) {
  writer().write(index, state);
}

void FrameWriter::finish() {
  writer().finish();
}

const std::string& FrameWriter::folder() const {
  return writer().path;
}

std::int64_t FrameWriter::earlierFrames() const {
  return writer().earlier_frames;
}

double FrameWriter::seconds() const {
  return writer().seconds;
}

}  // namespace spring_pendulum

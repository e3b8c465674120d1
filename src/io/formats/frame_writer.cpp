#include "io/formats/frame_writer.hpp"

#include "base/numbers.hpp"
#include "base/stopwatch.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr std::size_t kLongestLine = 2 * (kLongestNumber + 1);
constexpr Eigen::Index kLinesAtOnce = 4096;
/// Copying a frame of more particles takes far less time than formatting it.
constexpr Eigen::Index kLargeFrame = 1000;

}  // namespace

FrameWriter::FrameWriter(const std::string& folder, std::int64_t first)
    : folder_(folder), lock_(folder_, kFramesLock, folder_.path(), AtomicFile::Lock::kOneWriter) {
  const Stopwatch stopwatch(seconds_);
  earlier_frames_ = removeFrames(folder_, first);
}

void FrameWriter::write(std::int64_t index, const State& state) {
  const bool gains = state.size() >= kLargeFrame && std::thread::hardware_concurrency() > 1;
  if (gains && !thread_.joinable()) {
    try {
      thread_ = std::thread([this] { work(); });
    } catch (const std::system_error&) {  // the system refuses a thread: write in this one
    }
  }
  if (thread_.joinable()) {
    handOver(index, state);
  } else {
    writeNow(index, state);
  }
}

void FrameWriter::handOver(std::int64_t index, const State& state) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !has_frame_; });
  if (error_) std::rethrow_exception(error_);
  index_ = index;
  state_ = state;
  has_frame_ = true;
  changed_.notify_all();
}

void FrameWriter::work() {
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

void FrameWriter::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameWriter::finish() {
  stop();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  const Stopwatch stopwatch(seconds_);
  lock_.discard();
  folder_.checkPath();
}

void FrameWriter::writeNow(std::int64_t index, const State& state) {
  const Stopwatch stopwatch(seconds_);
  const Eigen::Index size = state.size();
  const double* const x = state.x().data();
  const double* const y = state.y().data();
  text_.resize(static_cast<std::size_t>(std::min(size, kLinesAtOnce)) * kLongestLine);
  const std::string name = frameName(index);
  AtomicFile file(folder_, name, folder_.path() + "/" + name, AtomicFile::Lock::kNone);
  for (Eigen::Index first = 0; first < size; first += kLinesAtOnce) {
    char* end = text_.data();
    for (Eigen::Index i = first; i < std::min(size, first + kLinesAtOnce); ++i)
      end = writeLine({x[i], y[i]}, end);
    file.write({text_.data(), static_cast<std::size_t>(end - text_.data())});
  }
  file.finish();
}

}  // namespace spring_pendulum

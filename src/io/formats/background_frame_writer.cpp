#include "io/formats/background_frame_writer.hpp"

#include <system_error>
#include <utility>

namespace spring_pendulum {

BackgroundFrameWriter::BackgroundFrameWriter(const std::string& folder, std::int64_t frames,
                                             std::int64_t first)
    : writer_(folder, frames, {}, first) {}

BackgroundFrameWriter::~BackgroundFrameWriter() {
  stop();
}

void BackgroundFrameWriter::write(std::int64_t index, const State& state) {
  const bool gains = state.size() >= kLargeFrame && std::thread::hardware_concurrency() > 1;
  if (gains && !thread_.joinable()) start();
  if (thread_.joinable()) {
    handOver(index, state);
  } else {
    writer_.write(index, state);
  }
}

void BackgroundFrameWriter::start() {
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error&) {  // the system refuses a thread: write in this one
  }
}

void BackgroundFrameWriter::handOver(std::int64_t index, const State& state) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return !has_frame_; });
  if (error_) std::rethrow_exception(error_);
  index_ = index;
  state_ = state;
  has_frame_ = true;
  changed_.notify_all();
}

void BackgroundFrameWriter::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return has_frame_ || stop_; });
    if (!has_frame_) return;
    lock.unlock();
    std::exception_ptr error;
    try {
      writer_.write(index_, state_);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    error_ = error;
    has_frame_ = false;
    changed_.notify_all();
  }
}

void BackgroundFrameWriter::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundFrameWriter::finish() {
  stop();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  writer_.finish();
}

}  // namespace spring_pendulum

#include "io/program/progress.hpp"

#include "io/program/standard_streams.hpp"

#include <fmt/format.h>

#include <unistd.h>

namespace spring_pendulum {
namespace {

constexpr std::chrono::seconds kFirstDelay{1};
constexpr std::chrono::milliseconds kNextDelay{200};

}  // namespace

Progress::Progress(std::int64_t frames)
    : frames_(frames),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      next_time_(Clock::now() + kFirstDelay) {}

Progress::~Progress() {
  if (is_visible_) printError("\r\x1b[K");
}

void Progress::show(std::int64_t frames_done) {
  if (!is_terminal_ || Clock::now() < next_time_) return;
  next_time_ = Clock::now() + kNextDelay;
  is_visible_ = true;
  printError(fmt::format("\r{} of {} frames, {:.0f} %\x1b[K", frames_done, frames_,
                         100.0 * static_cast<double>(frames_done) / static_cast<double>(frames_)));
}

}  // namespace spring_pendulum

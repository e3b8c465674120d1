#include "io/program/progress.hpp"

#include "base/numbers.hpp"
#include "io/program/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unistd.h>
#include <utility>

namespace spring_pendulum {

Progress::Progress(std::int64_t total, std::string unit)
    : total_(std::max<std::int64_t>(1, total)),
      unit_(std::move(unit)),
      is_terminal_(::isatty(STDERR_FILENO) == 1),
      delay_(is_terminal_ ? 1 : 60),
      next_time_(start_ + delay_) {}

Progress::~Progress() {
  if (is_visible_) printError("\r\x1b[K");
}

void Progress::show(std::int64_t done) {
  if (done_before_ < 0) done_before_ = done;
  const Clock::time_point now = Clock::now();
  if (now < next_time_) return;
  next_time_ = now + delay_;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  const double rate = static_cast<double>(done - done_before_) / seconds;
  const double left = static_cast<double>(std::max<std::int64_t>(0, total_ - done));
  const std::string text = fmt::format(
      "{} of {} {}, {:.0f} %{}", done, total_, unit_,
      100.0 * static_cast<double>(done) / static_cast<double>(total_),
      rate > 0.0 ? fmt::format(", {} per second, {:.0f} s left", roundedText(rate, 3), left / rate)
                 : "");
  printError(is_terminal_ ? '\r' + text + "\x1b[K" : text + '\n');
  is_visible_ = is_terminal_;
}

}  // namespace spring_pendulum

#include "sweep/running/progress.hpp"

#include "base/numbers.hpp"
#include "io/program/standard_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unistd.h>

namespace spring_pendulum::sweep {
namespace {

constexpr std::chrono::seconds kFirstDelay{1};
constexpr std::chrono::milliseconds kNextDelay{200};
constexpr std::chrono::minutes kDelayInLog{1};

}  // namespace

SweepProgress::SweepProgress(std::int64_t cases)
    : cases_(cases), is_terminal_(::isatty(STDERR_FILENO) == 1), next_time_(start_) {
  next_time_ += is_terminal_ ? Clock::duration(kFirstDelay) : Clock::duration(kDelayInLog);
}

SweepProgress::~SweepProgress() {
  if (is_visible_) printError("\r\x1b[K");
}

void SweepProgress::show(std::int64_t cases_done) {
  if (Clock::now() < next_time_) return;
  next_time_ = Clock::now() + (is_terminal_ ? Clock::duration(kNextDelay) : kDelayInLog);
  const double rate = static_cast<double>(cases_done) / seconds();
  const auto left = static_cast<double>(std::max<std::int64_t>(0, cases_ - cases_done));
  const std::string text = fmt::format(
      "{} of {} cases, {:.0f} %, {} per second{}", cases_done, cases_,
      100.0 * static_cast<double>(cases_done) /
          static_cast<double>(std::max<std::int64_t>(1, cases_)),
      roundedText(rate, 3), rate > 0.0 ? fmt::format(", {:.0f} s left", left / rate) : "");
  printError(is_terminal_ ? '\r' + text + "\x1b[K" : text + '\n');
  is_visible_ = is_terminal_;
}

double SweepProgress::seconds() const {
  return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace spring_pendulum::sweep

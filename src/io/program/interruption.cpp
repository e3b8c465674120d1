#include "io/program/interruption.hpp"

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <initializer_list>
#include <limits>

namespace spring_pendulum {
namespace {

/// Signals this close to the first one are its repetitions, in ns.
constexpr std::int64_t kRepetitions = 500'000'000;

// Atomic instead of volatile sig_atomic_t, because other threads read it as well.
std::atomic<int> received_signal{0};
std::atomic<std::int64_t> repeated_until{std::numeric_limits<std::int64_t>::max()};
std::atomic<void (*)()> called_too{nullptr};
static_assert(std::atomic<int>::is_always_lock_free &&
                  std::atomic<std::int64_t>::is_always_lock_free &&
                  std::atomic<void (*)()>::is_always_lock_free,
              "a signal handler must not wait for a lock");

std::int64_t nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

void remember(int signal_number) {
  int none = 0;
  if (received_signal.compare_exchange_strong(none, signal_number)) {
    repeated_until = nanoseconds() + kRepetitions;
    if (void (*const also)() = called_too) also();
  } else if (nanoseconds() > repeated_until) {
    std::signal(signal_number, SIG_DFL);
    std::raise(signal_number);  // delivered when this handler returns
  }
}

}  // namespace

void catchInterruptions(void (*also)()) {
  called_too = also;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    sigaction(signal_number, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(signal_number, &action, nullptr);
  }
}

int interruption() {
  return received_signal;
}

}  // namespace spring_pendulum

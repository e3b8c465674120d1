#include "io/program/interruption.hpp"

#include <atomic>
#include <csignal>
#include <initializer_list>

namespace spring_pendulum {
namespace {

// Atomic instead of volatile sig_atomic_t, because other threads read it as well.
std::atomic<int> received_signal{0};
std::atomic<void (*)()> called_too{nullptr};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<void (*)()>::is_always_lock_free,
              "a signal handler must not wait for a lock");

void remember(int signal_number) {
  received_signal = signal_number;
  if (void (*const also)() = called_too) also();
}

}  // namespace

void catchInterruptions(void (*also)()) {
  called_too = also;
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    if (interruption() != 0) return;  // the next signal ends the program
    struct sigaction present {};
    sigaction(signal_number, nullptr, &present);
    if (present.sa_handler != SIG_IGN) sigaction(signal_number, &action, nullptr);
  }
}

int interruption() {
  return received_signal;
}

}  // namespace spring_pendulum

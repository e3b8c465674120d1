#include "io/interruption.hpp"

#include <csignal>

namespace spring_pendulum {
namespace {

volatile std::sig_atomic_t received_signal = 0;

void remember(int signal_number) {
  received_signal = signal_number;
}

}  // namespace

void catchInterruptions() {
  struct sigaction action {};
  action.sa_handler = remember;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int interruption() {
  return received_signal;
}

}  // namespace spring_pendulum

#include "io/program/program.hpp"

#include "base/spelling.hpp"
#include "io/files/posix.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/outcome.hpp>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fcntl.h>
#include <initializer_list>
#include <limits>
#include <new>
#include <unistd.h>

namespace spring_pendulum {
namespace {

[[noreturn]] void refuseOutput() {
  throw FileError("standard output: could not be written: " + messageForErrno());
}

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

std::string noteLines(const Remarks& remarks) {
  std::string text;
  for (const std::string& note : remarks.notes) text += note + "\n";
  return text;
}

void prepareProcess() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    // open() returns the lowest free number, which is that of this stream. With the opposite access
    // mode, using the stream still fails.
    const int mode = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", mode) != stream) return;
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

Failure failureOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {"not enough memory", kFileFailed};
  }
  const bool bad_input = dynamic_cast<const InputError*>(&error) != nullptr;
  return {onOneLine(error.what()), bad_input ? kBadInput : kFileFailed};
}

int runProgram(const std::function<int()>& program,
               const std::function<void(const std::string&)>& report) {
  prepareProcess();
  try {
    const int status = program();
    flushOutput();
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    report ? report(failure.message) : printError(failure.message + "\n");
    return failure.status;
  }
}

void printOutput(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuseOutput();
}

void flushOutput() {
  if (std::fflush(stdout) != 0) refuseOutput();
}

void printError(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
}

std::string warningLine(const std::string& warning) {
  return warning.empty() ? "" : "warning: " + warning + "\n";
}

void printClosingLine(const std::string& text) {
  printOutput(onOneLine(text) + "\n");
  flushOutput();
}

int printAdvice(const Run& run) {
  printError(noteLines(remarksOn(run)));
  printOutput(checkStability(run.chain(), run.start(), run.plan().from(run.firstFrame())).text);
  return kDone;
}

std::string startLines(const Run& run) {
  const Remarks remarks = remarksOn(run);
  return noteLines(remarks) + warningLine(remarks.warning);
}

int conclude(const Run& run) {
  const Outcome outcome = outcomeOf(run, interruption);
  for (const std::string& line : outcome.lines) {
    printError(outcome.status == 0 ? warningLine(line) : line + "\n");
  }
  return interruption() == 0 || outcome.status != 0 ? outcome.status : kSignalled + interruption();
}

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

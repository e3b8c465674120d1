#include "io/program/standard_streams.hpp"

#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fcntl.h>
#include <unistd.h>

namespace spring_pendulum {
namespace {

[[noreturn]] void refuseOutput() {
  throw FileError("standard output: could not be written: " + messageForErrno());
}

}  // namespace

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

void printOutput(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) refuseOutput();
}

void flushOutput() {
  if (std::fflush(stdout) != 0) refuseOutput();
}

void printError(std::string_view text) noexcept {
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace spring_pendulum

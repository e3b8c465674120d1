#include "isolated.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <poll.h>
#include <stdexcept>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace spring_pendulum::benchmark {
namespace {

// A sleeping process uses no processor time: it is ended after this multiple of the limit in
// wall-clock time.
constexpr double kPatience = 30.0;

/// Ends this process with SIGPROF after a processor time in s.
void limitProcessorTime(double limit) {
  const auto whole = static_cast<time_t>(limit);
  const auto rest = static_cast<suseconds_t>(1e6 * (limit - static_cast<double>(whole)));
  const itimerval timer{{0, 0}, {whole, rest}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

/// The child process. The first character of its output is its status.
[[noreturn]] void work(const std::function<std::string()>& task, int pipe_end) {
  std::string message;
  try {
    message = "+" + task();
  } catch (const std::exception& error) {
    message = std::string("-") + error.what();
  }
  const ssize_t sent = write(pipe_end, message.data(), message.size());
  _exit(sent == static_cast<ssize_t>(message.size()) ? 0 : 1);
}

/// Reads until the other end closes; false on timeout.
bool receive(int pipe_end, double limit, std::string& message) {
  const auto start = std::chrono::steady_clock::now();
  std::array<char, 4096> buffer{};
  while (true) {
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const double left = limit - spent.count();
    pollfd waiting{pipe_end, POLLIN, 0};
    if (left <= 0.0 || poll(&waiting, 1, static_cast<int>(left * 1e3) + 1) == 0) return false;
    const ssize_t count = read(pipe_end, buffer.data(), buffer.size());
    if (count <= 0) return true;
    message.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

}  // namespace

Isolated runIsolated(const std::function<std::string()>& task, double limit) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::runtime_error("no pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) {
    close(ends[0]);
    limitProcessorTime(limit);
    work(task, ends[1]);
  }
  close(ends[1]);
  std::string message;
  const bool in_time = receive(ends[0], kPatience * limit, message);
  close(ends[0]);
  if (!in_time) kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  const bool in_limit = in_time && !(WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF);
  if (!in_limit) return {Isolated::Ending::kTooSlow, fmt::format("longer than {} s", limit)};
  if (WIFSIGNALED(status)) {
    return {Isolated::Ending::kFailed, fmt::format("ended by signal {}", WTERMSIG(status))};
  }
  if (message.empty()) {
    return {Isolated::Ending::kFailed, fmt::format("left with status {}", WEXITSTATUS(status))};
  }
  const bool done = message.front() == '+';
  return {done ? Isolated::Ending::kDone : Isolated::Ending::kFailed, message.substr(1)};
}

std::vector<double> numbersOf(const std::string& text) {
  std::vector<double> numbers;
  const char* rest = text.c_str();
  char* end = nullptr;
  for (double value = std::strtod(rest, &end); end != rest; value = std::strtod(rest, &end)) {
    numbers.push_back(value);
    rest = end;
  }
  return numbers;
}

}  // namespace spring_pendulum::benchmark

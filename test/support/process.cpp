#include "support/process.hpp"

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <linux/capability.h>
#include <stdexcept>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

constexpr int kCouldNotStart = 127;

[[noreturn]] void becomeProgram(const Command& command, int output, int errors) {
  std::vector<char*> arguments;
  for (const std::string& argument : command.arguments)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  for (const auto& [name, value] : command.environment) setenv(name.c_str(), value.c_str(), 1);
  dup2(output, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  if (chdir(command.folder.c_str()) != 0) _exit(kCouldNotStart);
  if (command.prepare) command.prepare();
  execvp(arguments[0], arguments.data());
  std::perror(arguments[0]);
  _exit(kCouldNotStart);
}

std::string takeText(int& descriptor) {
  std::string text;
  std::array<char, 4096> piece{};
  lseek(descriptor, 0, SEEK_SET);
  for (ssize_t count = 1; count > 0;) {
    count = read(descriptor, piece.data(), piece.size());
    if (count > 0) text.append(piece.data(), static_cast<std::size_t>(count));
  }
  close(std::exchange(descriptor, -1));
  return text;
}

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Process::Process(const Command& command)
    : output_(memfd_create("output", MFD_CLOEXEC)), errors_(memfd_create("errors", MFD_CLOEXEC)) {
  pid_ = fork();
  if (pid_ == 0) becomeProgram(command, output_, errors_);
  if (pid_ < 0) throw std::runtime_error("could not fork");
}

Process::~Process() {
  if (pid_ < 0) return;
  sendSignal(SIGKILL);
  wait();
}

void Process::sendSignal(int signal_number) {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(pid_, &clock) == 0 && clock_gettime(clock, &used) == 0)
    seconds_before_signal_ =
        static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
  kill(pid_, signal_number);
}

void Process::waitForFile(const std::string& path) const {
  const auto is_there = [&] { return readFile(path).find('\n') != std::string::npos; };
  while (!is_there()) {
    siginfo_t ended{};
    waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT);
    if (ended.si_pid == pid_ && !is_there()) throw std::runtime_error(path + " was not written");
    usleep(200);
  }
}

Result Process::wait() {
  int status = 0;
  rusage usage{};
  if (wait4(std::exchange(pid_, -1), &status, 0, &usage) < 0)
    throw std::runtime_error("no such child");
  const int exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {exit_status, takeText(output_), takeText(errors_),
          1024.0 * static_cast<double>(usage.ru_maxrss),
          secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime) - seconds_before_signal_};
}

Result run(const Command& command) {
  return Process(command).wait();
}

// The capabilities leave the bounding set, so root does not regain them when the program starts.
void respectPermissions() {
  if (geteuid() != 0) return;
  if (prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE) != 0) _exit(kCouldNotStart);
  if (prctl(PR_CAPBSET_DROP, CAP_DAC_READ_SEARCH) != 0) _exit(kCouldNotStart);
}

}  // namespace spring_pendulum

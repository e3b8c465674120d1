#include "sweep/table.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace spring_pendulum::sweep {

int drawPlot(const Study& study, const std::string& table, const std::string& picture,
             bool only_try) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe");
  // Debian's Python has matplotlib. -E -Xutf8: neither variables nor the locale change the picture.
  std::vector<std::string> arguments{"/usr/bin/python3", "-BE", "-Xutf8",
                                     program.parent_path() / "plot_table.py",
                                     "--title=" + study.name};
  arguments.insert(arguments.end(), study.plot.begin(), study.plot.end());
  if (only_try) arguments.emplace_back("--try");
  arguments.insert(arguments.end(), {"--", "/dev/stdin", picture});
  std::vector<char*> argv(arguments.size() + 1);  // null at the end
  for (std::size_t i = 0; i < arguments.size(); ++i) argv[i] = arguments[i].data();
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  // The path of an unfinished table is valid in the child only until the script starts.
  ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, table.c_str(), O_RDONLY, 0);
  pid_t child = 0;
  ::signal(SIGCHLD, SIG_DFL);  // if it is ignored, the child leaves no status
  // Python would print a traceback before the first line of the script, which ends the blocking.
  sigset_t interrupt, before;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  ::pthread_sigmask(SIG_BLOCK, &interrupt, &before);
  int status = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), ::environ);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::posix_spawn_file_actions_destroy(&actions);
  if (status != 0) throw FileError("--plot: could not run " + arguments[0]);
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace spring_pendulum::sweep

#include "sweep/plot.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <cerrno>
#include <filesystem>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace spring_pendulum::sweep {
namespace {

constexpr const char* kPython = "/usr/bin/python3";  // the one that has matplotlib from Debian

/// Runs the script with these arguments. \returns whether it succeeded; it prints why not
bool runScript(std::vector<std::string> arguments) {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string script = (program.parent_path() / "plot_table.py").string();
  arguments.insert(arguments.begin(), {kPython, script});
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  if (::posix_spawn(&child, kPython, nullptr, nullptr, argv.data(), ::environ) != 0) return false;
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return status == 0;
}

}  // namespace

void requirePlotter() {
  if (runScript({"--test"})) return;
  throw FileError("--plot: needs python3 with matplotlib (Debian: python3-matplotlib)");
}

void drawPlot(const Study& study, const std::string& table, const std::string& picture) {
  const PlotOptions& plot = study.plot;
  constexpr const char* kTypes[] = {"", "map", "lines", "histogram"};
  std::vector<std::string> arguments{table, picture, "--type", kTypes[static_cast<int>(plot.type)]};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) arguments.push_back(std::string(option) + "=" + value);
  };
  add("--x", plot.x);
  add("--y", plot.y);
  add("--color", plot.color);
  add("--lines", plot.lines);
  add("--panels", plot.panels);
  add("--limit", plot.limit);
  add("--title", plot.title.empty() ? study.name : plot.title);
  add("--log", std::string(plot.log_x ? "x" : "") + (plot.log_y ? "y" : ""));
  if (!runScript(arguments)) throw FileError(picture + ": could not be drawn");
}

}  // namespace spring_pendulum::sweep

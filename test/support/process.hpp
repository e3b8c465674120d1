// Runs programs from a test, with arguments, environment and folder, and captures their output.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

#include "support/temporary_folder.hpp"

namespace spring_pendulum {

struct Command {
  std::vector<std::string> arguments;  ///< the first one is the program, found by PATH
  std::string folder = ".";
  std::map<std::string, std::string> environment = {};  ///< in addition to that of the test
  std::function<void()> prepare = {};  ///< called in the child before the program starts
};

struct Result {
  int status = 0;  ///< exit status; 128 + signal if a signal ended the program
  std::string output;
  std::string errors;
  double peak_memory = 0.0;  ///< B
  /// Computing time after the last signal, s: it does not depend on what else the computer does.
  double seconds_after_signal = 0.0;
};

/// A running program, killed if it is still running at the end of its scope.
class Process {
 public:
  explicit Process(const Command& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void sendSignal(int signal_number);
  /// Waits until the program has written a line of a file.
  /// \throws std::runtime_error if the program ends without it
  void waitForFile(const std::string& path) const;
  Result wait();

 private:
  pid_t pid_ = -1;
  double seconds_before_signal_ = 0.0;  ///< computing time
  int output_ = -1;  ///< memory files, so that the output is not limited by a pipe
  int errors_ = -1;
};

Result run(const Command& command);

/// For Command::prepare: makes file permissions apply to root as well.
void respectPermissions();

}  // namespace spring_pendulum

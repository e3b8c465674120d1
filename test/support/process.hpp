// Programs run from a test: with arguments, environment and folder of their own, and what they
// said.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <sys/types.h>
#include <vector>

namespace spring_pendulum {

struct Command {
  std::vector<std::string> arguments;  ///< the first one is the program, found by PATH
  std::string folder = ".";
  std::map<std::string, std::string> environment = {};  ///< in addition to the test's own
  std::function<void()> prepare = {};  ///< called in the child before the program starts
};

struct Result {
  int status = 0;  ///< exit status; 128 + signal if a signal ended the program
  std::string output;
  std::string errors;
};

/// A running program, killed if it is still running at the end of its scope.
class Process {
 public:
  explicit Process(const Command& command);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void sendSignal(int signal_number) const;
  Result wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;  ///< memory files: a program can say as much as it likes
  int errors_ = -1;
};

Result run(const Command& command);

/// For Command::prepare: root is bound by the permissions of files like everybody else.
void respectPermissions();

/// A new empty folder, removed with all it holds at the end of its scope.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string path(const std::string& name) const { return path_ + "/" + name; }
  /// \return the path of the file
  std::string write(const std::string& name, const std::string& text) const;

 private:
  std::string path_;
};

/// Names of all entries of a folder, hidden ones too, sorted.
std::vector<std::string> listFolder(const std::string& folder);

std::string readFile(const std::string& path);

}  // namespace spring_pendulum

// The CSV file of a benchmark. Its head names the machine, the compiler, its flags and the commit.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

class ResultFile {
 public:
  /// \param title   lines that describe the measurement and how to read it
  /// \param columns names with units
  ResultFile(const std::string& path, const std::vector<std::string>& title,
             const std::string& columns);

  /// Adds a row. Lines are flushed at once, so that an interrupted run leaves a readable file.
  void add(const std::string& row);

 private:
  std::ofstream file_;
};

/// Formats text as a CSV field: in quotes, on one line.
std::string quoted(const std::string& text);

}  // namespace spring_pendulum::benchmark

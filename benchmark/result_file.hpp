// The CSV file of a benchmark. Its head says on which machine, with which compiler and flags, and
// from which commit it was made.
#pragma once

#include <fstream>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

class ResultFile {
 public:
  /// \param title   what was measured, and how to read it, one line each
  /// \param columns names with units
  ResultFile(const std::string& path, const std::vector<std::string>& title,
             const std::string& columns);

  /// One row; whole lines reach the file at once, so that an ended run leaves a readable file.
  void add(const std::string& row);

 private:
  std::ofstream file_;
};

/// A text as a CSV field: in quotes, on one line.
std::string quoted(const std::string& text);

}  // namespace spring_pendulum::benchmark

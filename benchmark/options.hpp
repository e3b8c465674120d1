// The command line of all benchmarks: pairs of a name and a value.
#pragma once

#include <string>

namespace spring_pendulum::benchmark {

struct Options {
  std::string output = ".";  ///< folder of the CSV file
  std::string scene;         ///< empty: all
  std::string peer;          ///< library or method; empty: all
  double limit = 2.0;        ///< s; a point that takes longer is recorded as too slow
  double budget = 0.02;      ///< s spent on one point in one pass, at least
  int passes = 2;
  bool smoke = false;  ///< few points, seconds in all: shows that everything works
};

/// \throws std::invalid_argument for a name it does not know
Options parseOptions(int count, char** words);

}  // namespace spring_pendulum::benchmark

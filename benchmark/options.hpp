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

/// A benchmark. Each program defines its own, and main.cpp calls it.
/// \return exit status; 1 if it throws, 2 for options that it does not know
int run(const Options& options);

}  // namespace spring_pendulum::benchmark

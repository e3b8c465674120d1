// The command line of all benchmarks: pairs of a name and a value.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace spring_pendulum::benchmark {

struct Options {
  std::string output = ".";            ///< folder of the CSV file
  std::string scene;                   ///< empty: all
  std::string peer;                    ///< library or method; empty: all
  std::vector<std::size_t> particles;  ///< lengths of chains, separated by commas; empty: all
  double limit = 2.0;    ///< s, longest time of a point; longer ones are recorded as too slow
  double budget = 0.02;  ///< s, least time per point and pass
  int passes = 2;
  bool busy_sibling = false;  ///< beside another program on the other thread of the core
  bool smoke = false;         ///< few points, in seconds: checks that everything works
};

/// The benchmark of a program, called by main.cpp.
/// \returns exit status: 1 for an exception, 2 for unknown options
int run(const Options& options);

}  // namespace spring_pendulum::benchmark

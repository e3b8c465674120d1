// The file of a reference scene, see test/data/reference/README.md. Also for benchmarks: without Eigen.
#pragma once

#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace spring_pendulum::test {

struct ReferenceTable {
  std::vector<int> times;                    ///< s, with an exact state
  std::vector<std::vector<double>> columns;  ///< x y m of the start, then x y vx vy per time

  /// The four columns of the exact state after `seconds`; throws if there is none.
  const std::vector<double>* stateAfter(int seconds) const {
    for (std::size_t i = 0; i < times.size(); ++i)
      if (times[i] == seconds) return &columns[3 + 4 * i];
    throw std::runtime_error("no reference solution at t = " + std::to_string(seconds) + " s");
  }
};

/// Reads `FOLDER/SCENE.txt`.
inline ReferenceTable readReferenceTable(const std::string& folder, const std::string& scene) {
  const std::string path = folder + '/' + scene + ".txt";
  std::ifstream file(path);
  std::string header;
  std::getline(file, header);
  ReferenceTable table;
  std::istringstream times(header.substr(header.find(':') + 1));
  for (int time = 0; times >> time;) table.times.push_back(time);
  table.columns.resize(3 + 4 * table.times.size());
  std::size_t i = 0;
  for (double value = 0.0; file >> value; ++i)
    table.columns[i % table.columns.size()].push_back(value);
  if (i == 0 || i % table.columns.size() != 0 || !file.eof())
    throw std::runtime_error("cannot read " + path);
  return table;
}

}  // namespace spring_pendulum::test

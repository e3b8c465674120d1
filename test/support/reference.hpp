// The scenes of test/data/reference and their exact motion.
#pragma once

#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/scene.hpp"

namespace spring_pendulum::test {

/// All numbers of a whitespace-separated file, row by row.
inline std::vector<std::vector<double>> readTable(const std::string& path, std::size_t columns) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::vector<double> row(columns);
  for (double value = 0.0; file >> value;) {
    row[0] = value;
    for (std::size_t column = 1; column < columns; ++column) file >> row[column];
    rows.push_back(row);
  }
  if (rows.empty() || !file.eof()) throw std::runtime_error("cannot read " + path);
  return rows;
}

/// A scene whose particles start at rest.
inline Scene referenceScene(const std::string& name, const SpringLaw& spring = {},
                            double gravity = 9.81) {
  const auto rows = readTable(TEST_DATA_DIR "/reference/" + name + ".txt", 3);
  Eigen::VectorXd masses(rows.size());
  State start(static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const auto& row = rows[static_cast<std::size_t>(i)];
    start.x()[i] = row[0];
    start.y()[i] = row[1];
    masses[i] = row[2];
  }
  return {name, Chain(masses, spring, gravity), start};
}

/// The exact state of a scene after `seconds`, a time for which the folder has a file.
inline State referenceSolution(const std::string& name, int seconds) {
  const auto rows =
      readTable(TEST_DATA_DIR "/reference/" + name + "_t" + std::to_string(seconds) + ".txt", 4);
  State state(static_cast<Eigen::Index>(rows.size()));
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      state.values()(i, column) =
          rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(column)];
    }
  }
  return state;
}

/// The largest error of a coordinate of a particle, m: the maximum norm.
inline double positionError(const State& state, const State& exact) {
  return (state.positions() - exact.positions()).cwiseAbs().maxCoeff();
}

}  // namespace spring_pendulum::test

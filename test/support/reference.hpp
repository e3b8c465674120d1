// The scenes of test/data/reference and their exact motion.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "support/reference_table.hpp"
#include "support/scene.hpp"

namespace spring_pendulum::test {

inline Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// A reference scene and times in s for which it has an exact state; a parameter of tests.
struct KnownMotion {
  std::string scene;
  std::vector<int> times;
};

inline std::ostream& operator<<(std::ostream& stream, const KnownMotion& motion) {
  return stream << motion.scene;
}

/// A scene whose particles start at rest.
inline Scene referenceScene(const std::string& name, const SpringLaw& spring = {},
                            double gravity = 9.81) {
  const ReferenceTable table = readReferenceTable(TEST_DATA_DIR "/reference", name);
  State start(static_cast<Eigen::Index>(table.columns[0].size()));
  start.x() = column(table.columns[0]);
  start.y() = column(table.columns[1]);
  return {name, Chain(column(table.columns[2]), spring, gravity), start};
}

/// The exact state of a scene after `seconds`, a time that its file has.
inline State referenceSolution(const std::string& name, int seconds) {
  const ReferenceTable table = readReferenceTable(TEST_DATA_DIR "/reference", name);
  const std::vector<double>* const exact = table.stateAfter(seconds);
  State state(static_cast<Eigen::Index>(exact->size()));
  for (Eigen::Index i = 0; i < 4; ++i) state.values().col(i) = column(exact[i]);
  return state;
}

/// The largest error of a coordinate of a particle, m: the maximum norm.
inline double positionError(const State& state, const State& exact) {
  return (state.positions() - exact.positions()).cwiseAbs().maxCoeff();
}

}  // namespace spring_pendulum::test

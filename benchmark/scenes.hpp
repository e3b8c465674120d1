// The benchmark scenes: scenes with a reference solution, and a chain of any length.
#pragma once

#include <string>
#include <vector>

#include "peer.hpp"

namespace spring_pendulum::benchmark {

/// A scene with known motion at the time `duration`.
struct ReferenceScene {
  Problem problem;
  double duration = 0.0;      ///< s
  std::vector<double> exact;  ///< 4N, as Problem::start
};

/// The scenes of test/data/reference, smallest first, and a stiff undamped cable.
std::vector<ReferenceScene> referenceScenes();

/// The horizontal chain of the exercise with any number of particles: 1 m apart, 1 kg each.
Problem horizontalChain(std::size_t particles);

/// Largest distance in m of a particle between two states; inf if a number of `state` is not
/// finite.
double positionError(const std::vector<double>& state, const std::vector<double>& exact);

/// Largest difference between two numbers of two states, m or m/s; inf as above.
double stateDifference(const std::vector<double>& state, const std::vector<double>& other);

}  // namespace spring_pendulum::benchmark

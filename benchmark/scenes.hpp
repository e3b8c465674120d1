// The scenes that are timed: those with a reference solution, and a chain of any length.
#pragma once

#include <string>
#include <vector>

#include "peer.hpp"

namespace spring_pendulum::benchmark {

/// A scene whose exact motion at `duration` is known.
struct ReferenceScene {
  Problem problem;
  double duration = 0.0;      ///< s
  std::vector<double> exact;  ///< 4N, as Problem::start
};

/// Those of test/data/reference that are there, smallest first.
std::vector<ReferenceScene> referenceScenes();

/// The exercise's chain with any number of particles: let go horizontally, 1 m apart, 1 kg each.
Problem horizontalChain(std::size_t particles);

/// Largest distance in m between the places of one particle in two states; inf if a number of
/// `state` is not finite.
double positionError(const std::vector<double>& state, const std::vector<double>& exact);

/// Largest difference between two numbers of two states, m or m/s; inf as above.
double stateDifference(const std::vector<double>& state, const std::vector<double>& other);

}  // namespace spring_pendulum::benchmark

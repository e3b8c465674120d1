// Estimates the memory of a run before it starts.
#pragma once

#include <spring_pendulum/simulation/plan.hpp>

#include <Eigen/Core>

#include <string>

namespace spring_pendulum {

/// Returns an upper estimate of the memory of a run, B. The messages of the node and a bag need more.
double expectedMemory(const Plan& plan, Eigen::Index particles);

/// Returns a remark if a run is expected to need 0.5 GB or more, else empty text:
/// "Radau-9 takes up to 1.35 GB of memory for 1000000 particles".
std::string memoryRemark(const Plan& plan, Eigen::Index particles);

/// Checks that a run is not expected to need more memory than this process may use.
/// \throws std::runtime_error if it is
void checkMemory(const Plan& plan, Eigen::Index particles);

}  // namespace spring_pendulum

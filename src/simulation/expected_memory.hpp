// Estimates the memory of a run before it starts.
#pragma once

#include <spring_pendulum/simulation/plan.hpp>

#include <Eigen/Core>

#include <string>

namespace spring_pendulum {

/// Returns an upper estimate of the memory of a run, B. The messages of the node and a bag need more.
double expectedMemory(const Plan& plan, Eigen::Index particles);

/// Returns a remark if a run is expected to need 0.5 GB or more, with the amount; else empty text.
std::string memoryRemark(const Plan& plan, Eigen::Index particles);

/// \throws std::runtime_error if a run is expected to need more memory than this process may use
void checkMemory(const Plan& plan, Eigen::Index particles);

}  // namespace spring_pendulum

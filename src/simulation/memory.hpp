// The memory that a run takes, known before it starts.
#pragma once

#include <spring_pendulum/simulation/scenario.hpp>

#include <Eigen/Core>

#include <string>

namespace spring_pendulum {

/// Memory that a run may take, B. Measured with Exercise3; a bag or a node's messages come on top.
double expectedMemory(const Scenario& scenario, Eigen::Index particles);

/// Memory that this process may use, B: that of the machine, or less if a limit is set (ulimit -v).
double usableMemory();

/// "Radau-9 takes up to 1.35 GB of memory for 1000000 particles" if it is much, else nothing.
std::string memoryRemark(const Scenario& scenario, Eigen::Index particles);

/// \throws std::runtime_error if a run may take more than `usable`
void checkMemory(const Scenario& scenario, Eigen::Index particles, double usable = usableMemory());

}  // namespace spring_pendulum

#include "simulation/expected_memory.hpp"

#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <sys/resource.h>
#include <unistd.h>

namespace spring_pendulum {
namespace {

/// Memory of every run per particle, B. Most of it is used while reading the particle file.
constexpr double kBytesPerParticle = 160.0;
/// Memory per particle of the two trajectories of a reference run, B.
constexpr double kBytesOfReference = 2.0 * 2700.0;
/// A run that is expected to need more memory than this says so, B.
constexpr double kMuch = 5e8;

std::string needOf(const Plan& plan, Eigen::Index particles) {
  return fmt::format("{} takes up to {:.2f} GB of memory for {} particles", plan.method.get().name,
                     1e-9 * expectedMemory(plan, particles), particles);
}

/// Returns the memory that this process may use, B: that of the machine, or less (ulimit -v).
double usableMemory() {
  static const double kMemory =  // short runs take little longer than asking for it
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kMemory;
  return std::min(kMemory, static_cast<double>(limit.rlim_cur));
}

}  // namespace

double expectedMemory(const Plan& plan, Eigen::Index particles) {
  const double reference = plan.reference == ReferenceUse::kAlways ? kBytesOfReference : 0.0;
  return static_cast<double>(particles) *
         (kBytesPerParticle + plan.method.get().bytes_per_particle + reference);
}

std::string memoryRemark(const Plan& plan, Eigen::Index particles) {
  return expectedMemory(plan, particles) < kMuch ? "" : needOf(plan, particles);
}

void checkMemory(const Plan& plan, Eigen::Index particles) {
  const double usable = usableMemory();
  if (expectedMemory(plan, particles) <= usable) return;
  throw std::runtime_error(
      fmt::format("not enough memory: {}, but this process can use only {:.2f} GB",
                  needOf(plan, particles), 1e-9 * usable));
}

}  // namespace spring_pendulum

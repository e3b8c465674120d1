#include "simulation/integrator_settings.hpp"

#include <algorithm>

namespace spring_pendulum {

IntegratorOptions integratorOptions(const Scenario& scenario, bool track_dissipation) {
  constexpr std::int64_t kMostThreads = 1024;
  IntegratorOptions options;
  options.tolerance = scenario.tolerance;
  options.track_dissipation = track_dissipation;
  options.threads = static_cast<int>(std::min(scenario.threads, kMostThreads));
  return options;
}

double workPerEvaluation(const Method& method, Eigen::Index particles) {
  if (!method.hasFixedStep()) return 1.0;
  return 0.35 + 0.007 * static_cast<double>(particles);
}

std::vector<std::string> skippedWork(const Scenario& scenario, const Integrator& integrator,
                                     bool tracks_dissipation) {
  const Skips skips = integrator.skips();
  std::vector<std::string> skipped;
  if (skips.damping) skipped.emplace_back("velocity differences: damping is 0");
  if (skips.gravity) skipped.emplace_back("gravity: it is 0");
  if (skips.masses) skipped.emplace_back("reading masses: all moving particles have the same");
  if (scenario.damping == 0.0) {
    skipped.emplace_back("dissipated energy: damping is 0");
  } else if (!tracks_dissipation) {
    skipped.emplace_back("dissipated energy: costly here, and no energy file is asked for");
  }
  if (scenario.no_frames) skipped.emplace_back("frame files: not written");
  return skipped;
}

}  // namespace spring_pendulum

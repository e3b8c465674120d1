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

std::string skippedWork(const Scenario& scenario, const Integrator& integrator,
                        bool tracks_dissipation) {
  const Skips skips = integrator.skips();
  std::string text;
  if (skips.damping) text += "skipped: velocity differences: damping is 0\n";
  if (skips.gravity) text += "skipped: gravity: it is 0\n";
  if (skips.masses) {
    text += "skipped: reading masses: all moving particles have the same mass\n";
  }
  if (scenario.damping == 0.0) {
    text += "skipped: dissipated energy: damping is 0\n";
  } else if (!tracks_dissipation) {
    text += "skipped: dissipated energy: expensive for this run; --energy FILE computes it\n";
  }
  if (scenario.no_frames) text += "skipped: frame files: not written\n";
  return text;
}

}  // namespace spring_pendulum

// A run at frame 0, with the chain of a scene.
#pragma once

#include <spring_pendulum/simulation/run.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include "support/scenes.hpp"

namespace spring_pendulum::test {

/// Returns a scenario with the constants of a scene.
inline Scenario scenarioFor(const Scene& scene, Scenario scenario = {}) {
  scenario.constants = scene.chain.constants();
  return scenario;
}

class ProgramRun : public Run {
 public:
  ProgramRun(const Scenario& scenario, const spring_pendulum::Scene& particles,
             const RunOptions& options = {})
      : Run(makeScene(scenario, particles), scenario, options) {
    advance();
  }
  /// A run of the scene, with its constants.
  ProgramRun(const Scenario& scenario, const Scene& scene, const RunOptions& options = {})
      : ProgramRun(scenarioFor(scene, scenario),
                   spring_pendulum::Scene{scene.chain.masses(), scene.start}, options) {}

  /// Advances to the first frame at or after `seconds`, or to the end of the run.
  void advanceTo(double seconds) {
    while (time() < seconds - 1e-9 && advance()) continue;
  }
  void reset() {
    Run::reset();
    advance();
  }
};

}  // namespace spring_pendulum::test

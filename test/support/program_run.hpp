// A run at frame 0, with the chain of a scene.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include "support/scenes.hpp"

namespace spring_pendulum::test {

/// Returns a scenario with the springs and the gravity of a scene.
inline Scenario scenarioFor(const Scene& scene, Scenario scenario = {}) {
  scenario.stiffness = scene.chain.spring().stiffness;
  scenario.damping = scene.chain.spring().damping;
  scenario.rest_length = scene.chain.spring().rest_length;
  scenario.gravity = scene.chain.gravity();
  return scenario;
}

class ProgramRun : public Run {
 public:
  ProgramRun(const Scenario& scenario, const Particles& particles, const RunOptions& options = {})
      : Run(scenario, particles, options) {
    advance();
  }
  /// A run of the scene, with its springs and its gravity.
  ProgramRun(const Scenario& scenario, const Scene& scene, const RunOptions& options = {})
      : ProgramRun(scenarioFor(scene, scenario), {scene.chain.masses(), scene.start}, options) {}

  /// Advances to the first frame at or after `seconds`, or to the end of the run.
  void advanceTo(double seconds) {
    while (time() < seconds - 1e-9 && advance()) {
    }
  }
  void reset() {
    Run::reset();
    advance();
  }
};

}  // namespace spring_pendulum::test

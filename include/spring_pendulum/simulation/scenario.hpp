// What a user asks of a program: a plan, constants and names of files. The initialisers are the defaults.
#pragma once

#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/simulation/option.hpp>
#include <spring_pendulum/simulation/plan.hpp>

#include <string>
#include <utility>
#include <vector>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Where a run starts: as the particle file says, or in the equilibrium of the chain.
enum class Start { kFile, kAtRest };

struct Scenario : Plan {
  Constants constants = {};
  Start start = Start::kFile;
  std::string particles = "particle.txt";  ///< the particle file
  bool resume = false;                     ///< go on from the frame of the state file `particles`
  std::string output = ".";                ///< folder for frame files
  bool no_frames = false;                  ///< write no frame files
  std::string energy = {};                 ///< file for the energy balance; empty: none
  std::string save_state = {};             ///< file for the state at the last frame; empty: none
};

/// Returns the options of a run in the order of the help text, bound to `scenario`, which has the defaults.
std::vector<Option> scenarioOptions(Scenario& scenario);

/// Makes a scenario from pairs of key and value; later pairs override earlier ones.
/// \param scenario values of the options that are not given
/// \throws InputError naming the option and its range for a wrong value, an unknown key (with the
///   nearest known one), an option that the method does not use, or options that contradict each other
Scenario makeScenario(const std::vector<std::pair<std::string, std::string>>& options,
                      Scenario scenario = {});

/// Makes the scene of a scenario from particles of any origin. Every program makes its scenes with it.
/// \throws InputError if a chain that starts at rest has no such start
Scene makeScene(const Scenario& scenario, Scene particles);

}  // namespace spring_pendulum
#pragma GCC visibility pop

#include "sweep/single_case.hpp"

#include "base/numbers.hpp"
#include "io/files/output_file.hpp"
#include "io/program/standard_streams.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace spring_pendulum::sweep {
namespace {

/// A word of a shell command.
std::string word(const std::string& text) {
  const bool is_plain = text.find_first_not_of(
                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                            "0123456789-_./+=:,@%") == std::string::npos;
  if (is_plain && !text.empty()) return text;
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

/// The options that differ from their defaults and that the method uses.
std::string commandLine(const Scenario& scenario) {
  Scenario copy = scenario, defaults;
  const std::vector<Option> options = scenarioOptions(copy), by_default = scenarioOptions(defaults);
  const AppliesTo other =
      scenario.method.get().hasFixedStep() ? AppliesTo::kErrorControlled : AppliesTo::kFixedStep;
  std::string text =
      fmt::format("Exercise3 {} {}", scenario.method.get().name, word(scenario.particles));
  for (std::size_t i = 0; i < options.size(); ++i) {
    const Option& option = options[i];
    if (option.key == "method" || option.key == "particles" || option.applies_to == other) continue;
    if (option.text() == by_default[i].text()) continue;
    std::string name(option.key);
    std::replace(name.begin(), name.end(), '_', '-');
    text += " --" + name + (option.isFlag() ? "" : " " + word(option.text()));
  }
  return text + "\n";
}

void writeParticles(const Particles& particles, const std::string& path) {
  OutputFile file(path);
  std::string text;
  for (Eigen::Index i = 0; i < particles.state.size(); ++i) {
    const State& state = particles.state;
    text += fmt::format("{} {} {} {} {}\n", numberText(state.x()[i]), numberText(state.y()[i]),
                        numberText(particles.masses[i]), numberText(state.vx()[i]),
                        numberText(state.vy()[i]));
  }
  file.write(text);
  file.finish();
}

}  // namespace

std::string particlesPath(const std::string& folder, std::int64_t index) {
  return fmt::format("{}/case_{}.txt", folder, index);
}

void printCase(const Study& study, std::int64_t index, const std::string& folder) {
  if (index >= study.cases()) {
    throw InputError(fmt::format("--case: must be from 0 to {}, got {}", study.cases() - 1, index));
  }
  Case made = caseOf(study, index);
  Scenario& scenario = made.settings.scenario;
  if (!folder.empty()) scenario.output = folder;
  const Run checked(scenario, made.particles);  // before anything is written
  if (study.changesParticles(made.settings)) {
    if (folder.empty()) {
      throw InputError(
          fmt::format("--case: case {} has particles that are in no file; give a folder for "
                      "them with --output",
                      index));
    }
    scenario.particles = particlesPath(folder, index);
    writeParticles(made.particles, scenario.particles);
  }
  printOutput(commandLine(scenario));
}

}  // namespace spring_pendulum::sweep

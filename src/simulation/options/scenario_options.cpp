#include "simulation/options/scenario_options.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/dynamics.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <limits>

namespace spring_pendulum {

void OptionSet::add(std::vector<Option> options) {
  std::move(options.begin(), options.end(), std::back_inserter(options_));
}

const Option& OptionSet::find(std::string_view key, std::string_view place,
                              std::string_view kind) const {
  std::vector<std::string> known;
  for (const Option& option : options_) {
    if (option.key == key) return option;
    known.emplace_back(option.key);
  }
  const std::string text = unknownName(kind, key, known);
  throw InputError(place.empty() ? text : fmt::format("{}: {}", place, text));
}

void OptionSet::set(const Option& option, std::string_view text, const std::string& place) {
  try {
    option.assign(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", place, error.what()));
  }
  given_[option.key] = place;
}

std::string OptionSet::placeOf(std::string_view key) const {
  const auto given = given_.find(key);
  return given == given_.end() ? "" : given->second;
}

std::vector<Option> scenarioOptions(Scenario& s) {
  constexpr auto kFixedStep = StepControl::kFixed;
  constexpr auto kErrorControlled = StepControl::kErrorControlled;
  SpringLaw& spring = s.constants.spring;
  return {
      {"method", MethodName{&s.method}, "", "integration method, one of Exercise3 --list-methods"},
      {"particles", Text{&s.particles, "FILE", "a file"}, "",
       "particle file, one line 'x y m' or 'x y m vx vy' per particle; the first particle is "
       "fixed"},
      {"resume", Flag{&s.resume}, "",
       "go on from the frame and time of the particle file, which is a file of save_state; frames "
       "before it stay"},
      {"output", Text{&s.output, "DIR", "a folder"}, "",
       "folder for the frame files, created if absent"},
      {"no_frames", Flag{&s.no_frames}, "", "write no frame files"},
      {"energy", Text{&s.energy, "FILE", "a file", anyText}, "",
       "CSV file for the energy balance, one row per frame; its folder is created if absent"},
      {"save_state", Text{&s.save_state, "FILE", "a file", anyText}, "",
       "file for the state at the last frame, a particle file to resume from; its folder is "
       "created if absent"},
      {"start", Choice(&s.start, {"file", "at_rest"}), "",
       "start: as the particle file says, or hanging at rest from its first particle"},
      {"on_divergence", Choice(&s.on_divergence, {"stop", "continue"}), "",
       "after a divergence: stop, or continue as long as every number is finite"},
      {"reference", Choice(&s.reference, {"auto", "always", "never"}), "",
       "measure the position error against a reference run: while it is cheap, to the end, or "
       "never; the frames do not depend on it"},
      {"frames", Count{&s.frames, Range::atLeast(1)}, "", "number of frames, including the start"},
      {"steps_per_frame", Count{&s.steps_per_frame, Range::atLeast(1)}, "",
       "integration steps per frame", kFixedStep},
      {"time_step", Number{&s.time_step, Range::above(0)}, "s", "integration step size",
       kFixedStep},
      {"tolerance", Number{&s.tolerance, Range::above(0)}, "m", "position error to aim at",
       kErrorControlled},
      {"frame_interval", Number{&s.frame_interval, Range::between(1e-300, 1e6)}, "s",
       "simulated time between frames", kErrorControlled},
      {"stiffness", Number{&spring.stiffness, Range::atLeast(0)}, "N/m", "spring constant k_s"},
      {"damping", Number{&spring.damping, Range::atLeast(0)}, "N·s/m", "damping constant k_d"},
      {"rest_length", Number{&spring.rest_length, Range::atLeast(0)}, "m",
       "length L_0 of an unloaded spring"},
      {"gravity", Number{&s.constants.gravity, Range::any()}, "m/s²", "gravity g (points down)"},
      {"air_drag", Number{&s.constants.air_drag, Range::atLeast(0)}, "N·s/m",
       "drag k_air of the air: the force -k_air v on each particle"},
      {"threads", Count{&s.threads, Range::atLeast(0)}, "",
       "largest number of threads; 0: one per processor core; results do not depend on it"},
      {"sleep", Number{&s.sleep, Range::atLeast(0)}, "m/s",
       "do not integrate if all particles stay slower than this for 1 s; 0: always integrate"},
  };
}

Scenario makeScenario(const std::vector<std::pair<std::string, std::string>>& options,
                      Scenario scenario) {
  OptionSet set(scenarioOptions(scenario));
  for (const auto& [key, text] : options) set.set(set.find(key, "", "option"), text, key);
  if (const auto unused = unusedKeys(scenario, set); !unused.empty())
    throw InputError(fmt::format(
        "{}: {}", unused.front(),
        whyUnused(scenario.method, [](std::string_view key) { return std::string(key); })));
  checkScenario(scenario);
  return scenario;
}

Scene makeScene(const Scenario& scenario, Scene particles) {
  particles.constants = scenario.constants;
  if (scenario.start == Start::kAtRest && particles.frame == 0)
    particles.state = equilibrium(particles.chain(), particles.state);
  return particles;
}

void checkPlan(const Plan& plan) {
  checkScenario(Scenario{plan});
}

void checkScenario(const Scenario& scenario) {
  Scenario copy = scenario;
  OptionSet options(scenarioOptions(copy));
  for (const Option& option : options.options()) {
    if (!option.isNumber() || !option.isUsedBy(scenario.method)) continue;
    options.set(option, option.text(), std::string(option.key));
  }
  if (scenario.resume && scenario.start == Start::kAtRest)
    throw InputError(
        "start: at_rest and resume exclude each other: a resumed run goes on from its saved state");
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const std::int64_t steps = scenario.steps();
  if (scenario.frames > kMost / steps) {  // frame times are computed from step counts
    throw InputError(fmt::format("frames times steps_per_frame must be at most {}, got {} times {}",
                                 kMost, scenario.frames, steps));
  }
  if (std::isfinite(scenario.timeOfFrame(scenario.frames - 1))) return;
  throw InputError(fmt::format(
      "frames times steps_per_frame times time_step must be finite, got {} times {} times {} s",
      scenario.frames, steps, numberText(scenario.step())));
}

void checkFirstFrame(const Plan& plan, std::int64_t frame) {
  if (frame < 0) throw InputError(fmt::format("frame: must be at least 0, got {}", frame));
  if (frame < plan.frames) return;
  throw InputError(
      fmt::format("frames: must be more than {}, the frame of the state to start from, got {}",
                  frame, plan.frames));
}

std::vector<std::string_view> unusedKeys(const Plan& plan, const OptionSet& options) {
  std::vector<std::string_view> keys;
  for (const Option& option : options.options())
    if (!option.isUsedBy(plan.method) && options.isGiven(option.key)) keys.push_back(option.key);
  return keys;
}

std::string whyUnused(const Method& method, std::string (*name)(std::string_view key)) {
  const bool fixed = method.hasFixedStep();
  return fmt::format(
      "{} {}; use {} and {}", method.name, fixed ? "takes fixed steps" : "chooses its own steps",
      name(fixed ? "time_step" : "tolerance"), name(fixed ? "steps_per_frame" : "frame_interval"));
}

}  // namespace spring_pendulum

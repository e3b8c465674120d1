#include "io/formats/state_file.hpp"

#include "base/numbers.hpp"
#include "io/files/text_file.hpp"
#include "io/formats/particle_parser.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/plan.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr Eigen::Index kLinesAtOnce = 4096;
constexpr std::string_view kHeader = "# state of ";

/// Removes and returns the text before `end`; empty if there is no `end`.
std::string_view takeUntil(std::string_view& text, std::string_view end) {
  const std::size_t at = text.find(end);
  if (at == std::string_view::npos) return {};
  const std::string_view taken = text.substr(0, at);
  text.remove_prefix(at + end.size());
  return taken;
}

/// The first line of a state file.
struct StateHead {
  std::int64_t particles = 0;
  std::int64_t frame = 0;
  double time = 0.0;  ///< s
};

std::optional<StateHead> findHead(std::string_view text) {
  std::string_view line = ParticleParser::nextLine(text);
  if (!takeUntil(line, kHeader).empty()) return {};
  const auto particles = parseInteger(takeUntil(line, " particles at frame "));
  const auto frame = parseInteger(takeUntil(line, ", t = "));
  const auto time = parseNumber(takeUntil(line, " s"));
  if (!particles || !frame || !time || *frame < 0) return {};
  return StateHead{*particles, *frame, *time};
}

StateHead parseStateHead(std::string_view text, const Scenario& scenario) {
  const std::optional<StateHead> head = findHead(text);
  if (!head) {
    throw InputError(fmt::format(
        "{}:1: must be '# state of N particles at frame N, t = X s' to resume from; give a file "
        "that was written by save_state",
        scenario.particles));
  }
  checkFirstFrame(scenario, head->frame);
  const double expected = scenario.timeOfFrame(head->frame);
  // A run that changed its method counts its time from there, with other rounding errors.
  if (std::abs(head->time - expected) <= 1e-9 * expected) return *head;
  throw InputError(fmt::format(
      "{}:1: the state is at t = {} s, but frame {} of this run is at {} s; give the {} of the "
      "run that saved it",
      scenario.particles, numberText(head->time), head->frame, numberText(expected),
      scenario.method.get().hasFixedStep() ? "time_step and steps_per_frame" : "frame_interval"));
}

void checkStateEnd(const StateHead& head, std::int64_t particles, bool has_velocities,
                   bool ends_line, const std::string& name) {
  if (particles == head.particles && has_velocities && ends_line) return;
  throw InputError(fmt::format(
      "{}: is not a complete state file; it must have {}, each with a line "
      "'x y m vx vy', got {}{}{}",
      name, counted(head.particles, "particle"), particles,
      has_velocities ? "" : " without velocities", ends_line ? "" : ", the last line without end"));
}

/// Lines that read back as the same bits.
std::string stateLines(AlignedNumbers::ConstView masses, const State& state, Eigen::Index first,
                       Eigen::Index last) {
  std::string text(static_cast<std::size_t>(last - first) * 5 * (kLongestNumber + 1), '\0');
  char* end = text.data();
  for (Eigen::Index i = first; i < last; ++i) {
    end = writeLine({state.x()[i], state.y()[i], masses[i], state.vx()[i], state.vy()[i]}, end);
  }
  text.resize(static_cast<std::size_t>(end - text.data()));
  return text;
}

void writeState(OutputFile& file, AlignedNumbers::ConstView masses, const State& state,
                std::int64_t frame, double time) {
  file.write(
      fmt::format("{}{} particles at frame {}, t = {} s\n"
                  "# x [m]  y [m]  mass [kg]  vx [m/s]  vy [m/s]\n",
                  kHeader, state.size(), frame, numberText(time)));
  for (Eigen::Index first = 0; first < state.size(); first += kLinesAtOnce) {
    file.write(stateLines(masses, state, first, std::min(state.size(), first + kLinesAtOnce)));
  }
  file.finish();
}

}  // namespace

Scene readStateFile(const Scenario& scenario) {
  const std::string text = readTextFile(scenario.particles);
  const StateHead head = parseStateHead(text, scenario);
  ParticleParser parser(scenario.particles);
  parser.parse(text);
  checkStateEnd(head, static_cast<std::int64_t>(parser.size()), parser.hasVelocities(),
                text.back() == '\n', scenario.particles);
  Scene particles = parser.particles(true);
  particles.frame = head.frame;
  return particles;
}

void writeStateFile(const std::string& path, const Chain& chain, const State& state,
                    std::int64_t frame, double time) {
  OutputFile file(path);
  std::string earlier;
  std::getline(std::ifstream(path), earlier);
  if (!earlier.empty() && earlier.rfind(kHeader, 0) != 0) {
    throw InputError(path + ": is not a state but another file; give another name");
  }
  writeState(file, chain.masses(), state, frame, time);
}

void StateFile::keep(const Run& run) {
  if (last_.masses.size() != run.chain().size()) last_.masses = run.chain().masses();
  last_.state = run.state();
  last_.frame = run.frame();
  time_ = run.time();
}

void StateFile::finish() {
  if (last_.masses.size() == 0) return;  // no frame was reached
  writeState(file_, std::as_const(last_.masses).view(), last_.state, last_.frame, time_);
}

}  // namespace spring_pendulum

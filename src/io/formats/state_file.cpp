#include "io/formats/state_file.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/formats/particle_rows.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string_view>

namespace spring_pendulum {
namespace {

constexpr std::string_view kHeader = "# state of ";
constexpr std::size_t kLongestHead = 200;  // bytes

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

std::optional<StateHead> parseHead(std::string_view text) {
  std::string_view line = text.substr(0, text.find('\n'));
  const bool begins = line.substr(0, kHeader.size()) == kHeader;
  line.remove_prefix(begins ? kHeader.size() : line.size());
  const auto particles = parseInteger(takeUntil(line, " particles at frame "));
  const auto frame = parseInteger(takeUntil(line, ", t = "));
  const auto time = parseNumber(takeUntil(line, " s"));
  if (!particles || !frame || !time || *frame < 0) return std::nullopt;
  return StateHead{*particles, *frame, *time};
}

}  // namespace

Scene readStateFile(const Scenario& scenario) {
  const std::string& name = scenario.particles;
  const bool begins = parseHead(readTextFile(name, kLongestHead)).has_value();
  const std::string text = begins ? readTextFile(name) : "";
  const std::optional<StateHead> head = parseHead(text);
  if (!head)
    throw InputError(fmt::format(
        "{}:1: must be '# state of N particles at frame N, t = X s' to resume from; give a file "
        "that was written by save_state",
        name));
  checkFirstFrame(scenario, head->frame);
  const double expected = scenario.timeOfFrame(head->frame);
  // A run that changed its method counts its time from there, with other rounding errors.
  if (!(std::abs(head->time - expected) <= 1e-9 * expected)) {
    throw InputError(fmt::format(
        "{}:1: the state is at t = {} s, but frame {} of this run is at {} s; give the {} of the "
        "run that saved it",
        name, numberText(head->time), head->frame, numberText(expected),
        scenario.method.get().hasFixedStep() ? "time_step and steps_per_frame" : "frame_interval"));
  }
  ParticleRows rows = parseRows(text, name, true);
  const std::int64_t count = rows.particles.masses.size();
  const bool ends_line = text.back() == '\n';
  if (count != head->particles || !rows.have_velocities || !ends_line) {
    throw InputError(
        fmt::format("{}: is not a complete state file; it must have {}, each with a line "
                    "'x y m vx vy', got {}{}{}",
                    name, counted(head->particles, "particle"), count,
                    rows.have_velocities ? "" : " without velocities",
                    ends_line ? "" : ", the last line without end"));
  }
  rows.particles.frame = head->frame;
  return std::move(rows.particles);
}

void writeState(OutputFile& file, const AlignedNumbers::ConstView& masses, const State& state,
                std::int64_t frame, double time) {
  file.write(
      fmt::format("{}{} particles at frame {}, t = {} s\n"
                  "# x [m]  y [m]  mass [kg]  vx [m/s]  vy [m/s]\n",
                  kHeader, state.size(), frame, numberText(time)));
  std::array<char, 5 * (kLongestNumber + 1)> line;
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    const char* const end = writeLine(
        {state.x()[i], state.y()[i], masses[i], state.vx()[i], state.vy()[i]}, line.data());
    file.write({line.data(), static_cast<std::size_t>(end - line.data())});
  }
  file.finish();
}

void writeStateFile(const std::string& path, const Chain& chain, const State& state,
                    std::int64_t frame, double time) {
  OutputFile file(path);
  const std::string earlier = file.earlierText(kLongestHead);
  if (!earlier.empty() && !parseHead(earlier))
    throw InputError(fullPath(path) + ": is not a state but another file; give another name");
  writeState(file, chain.masses(), state, frame, time);
}

}  // namespace spring_pendulum

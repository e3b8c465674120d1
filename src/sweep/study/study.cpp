#include "sweep/study/study.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include "sweep/study/random_numbers.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace spring_pendulum::sweep {
namespace {

/// Quantities with random numbers of their own.
constexpr std::uint32_t kMass = 0;
constexpr std::uint32_t kDisplacement = 1;
constexpr std::uint32_t kVelocity = 2;
constexpr double kMostStepsPerFrame = 1e6;
/// Options that belong to a single run, not to a case.
constexpr std::string_view kOfOneRun[] = {"resume", "output",     "no_frames",
                                          "energy", "save_state", "threads"};

double draw(const Distribution& distribution, RandomNumbers& numbers) {
  const auto [first, second, is_given, is_log, is_range] = distribution;
  if (!is_given) return first;
  const double a = is_log ? portableLog(first) : first;
  const double b = is_log && is_range ? portableLog(second) : second;
  const double number = is_range ? a + (b - a) * numbers.uniform() : a + b * numbers.normal();
  return is_log ? portableExp(number) : number;
}

/// The least whole number of parts, so that none is longer than wanted.
double partsOf(double whole, double wanted) {
  return std::max(1.0, std::ceil(whole / wanted - 1e-9));
}

bool isSame(double duration, double other) {
  return std::abs(other - duration) <= 1e-9 * duration;
}

/// Sets frames that end at the duration.
void setFrames(Settings& settings) {
  Scenario& scenario = settings.scenario;
  const double duration = settings.duration;
  if (duration == 0.0) return;
  double frames = partsOf(duration, scenario.frame_interval);
  if (scenario.method.get().hasFixedStep()) {
    const double fitted = fittedTimeStep(settings, scenario.time_step);
    if (fitted != scenario.time_step)
      throw InputError(
          fmt::format("time_step: whole steps must end at the duration, {} s, got {} s; try {}",
                      numberText(duration), numberText(scenario.time_step), numberText(fitted)));
    const double steps = std::round(duration / fitted);
    double per_frame = std::floor(scenario.frame_interval / fitted + 1e-9);
    per_frame = std::clamp(per_frame, 1.0, std::min(steps, kMostStepsPerFrame));
    while (std::fmod(steps, per_frame) != 0.0) --per_frame;
    scenario.steps_per_frame = static_cast<std::int64_t>(per_frame);
    frames = steps / per_frame;
  } else if (!isSame(duration, frames * scenario.frame_interval)) {
    scenario.frame_interval = duration / frames;
  }
  // More frames than 64 bits can count are refused with the other options.
  scenario.frames = static_cast<std::int64_t>(std::min(frames + 1.0, 9e18));
}

/// Sets the particles of the file, changed by the factors and random numbers of a case.
void setParticles(const Study& study, Case& made) {
  made.particles = study.particles.at(made.settings.scenario.particles);
  if (!study.changesParticles(made.settings)) return;
  if (made.settings.scenario.start == Start::kAtRest &&
      (study.displacement.is_given || study.velocity.is_given))
    throw InputError("start: at_rest: leave out random displacement and velocity");
  State& state = made.particles.state;
  for (Eigen::Index i = 1; i < state.size(); ++i) {  // the mass of the fixed particle is not used
    const auto numbers_of = [&](std::uint32_t quantity) {
      return RandomNumbers(static_cast<std::uint64_t>(study.seed),
                           static_cast<std::uint64_t>(made.sample), static_cast<std::uint32_t>(i),
                           quantity);
    };
    RandomNumbers of_mass = numbers_of(kMass), of_position = numbers_of(kDisplacement),
                  of_velocity = numbers_of(kVelocity);
    double& mass = made.particles.masses[i];
    mass *= made.settings.mass_factor;
    mass *= draw(study.mass_factor, of_mass);
    if (!std::isfinite(mass) || mass <= 0.0)
      throw InputError(fmt::format("particle {}: mass must be positive and finite, got {}", i + 1,
                                   numberText(mass)));
    state.x()[i] += draw(study.displacement, of_position);
    state.y()[i] += draw(study.displacement, of_position);
    state.vx()[i] += draw(study.velocity, of_velocity);
    state.vy()[i] += draw(study.velocity, of_velocity);
  }
}

}  // namespace

double fittedTimeStep(const Settings& settings, double time_step) {
  const double duration = settings.duration;
  if (!(time_step > 0.0)) return time_step;  // is refused later
  if (isSame(duration, std::round(duration / time_step) * time_step)) return time_step;
  // A power of 2 of steps per frame, so that there is no frame for each of a prime number of steps.
  double per_frame = 1.0;
  const double frame = std::min(settings.scenario.frame_interval, duration);
  while (2.0 * per_frame * time_step <= frame) per_frame *= 2.0;
  return duration / (per_frame * partsOf(duration, per_frame * time_step));
}

std::vector<Option> caseOptions(Settings& s) {
  std::vector<Option> options{{"duration", Number{&s.duration, Range::above(0)}, "s",
                               "simulated time, in frames of frame_interval; else given by frames"},
                              {"mass_factor", Number{&s.mass_factor, Range::above(0)}, "",
                               "factor for the masses of the particle file"}};
  for (const Option& option : scenarioOptions(s.scenario)) {
    const auto* const found = std::find(std::begin(kOfOneRun), std::end(kOfOneRun), option.key);
    if (found == std::end(kOfOneRun)) options.push_back(option);
  }
  return options;
}

std::int64_t Study::cases() const {
  double cases = std::max(1.0, static_cast<double>(samples));
  for (const Axis& axis : axes) {
    if (!axis.is_joined) cases *= static_cast<double>(axis.values.size());
  }
  return static_cast<std::int64_t>(std::min(cases, 2.0 * kMostCases));
}

Place Study::placeOf(std::int64_t index) const {
  Place place{std::vector<std::string>(axes.size()), 0};
  auto left = static_cast<std::size_t>(index);
  for (std::size_t i = axes.size(); i-- > 0;) {
    place.values[i] = axes[i].values[left % axes[i].values.size()];
    if (!axes[i].is_joined) left /= axes[i].values.size();
  }
  place.sample = static_cast<std::int64_t>(left);
  return place;
}

bool Study::changesParticles(const Settings& settings) const {
  return settings.mass_factor != 1.0 || mass_factor.is_given || displacement.is_given ||
         velocity.is_given;
}

Case caseOf(const Study& study, std::int64_t index) {
  const Place place = study.placeOf(index);
  Case made{place.sample, study.base, {}};
  const OptionSet options(caseOptions(made.settings));
  for (std::size_t i = 0; i < study.axes.size(); ++i)
    options.find(study.axes[i].key, "").assign(place.values[i]);
  setFrames(made.settings);
  setParticles(study, made);
  return made;
}

}  // namespace spring_pendulum::sweep

#include "sweep/study/study.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sweep/study/random_numbers.hpp"

namespace spring_pendulum::sweep {
namespace {

/// Quantities with random numbers of their own.
constexpr std::uint32_t kMass = 0;
constexpr std::uint32_t kDisplacement = 1;
constexpr std::uint32_t kVelocity = 2;

/// Options that belong to a single run, not to a case.
constexpr std::string_view kOfOneRun[] = {"resume", "output",     "no_frames",
                                          "energy", "save_state", "threads"};

double draw(const Distribution& distribution, RandomNumbers& numbers) {
  const double a = distribution.first, b = distribution.second;
  switch (distribution.kind) {
    case Distribution::Kind::kUniform:
      return a + (b - a) * numbers.uniform();
    case Distribution::Kind::kLogUniform: {
      const double log_a = portableLog(a);
      return portableExp(log_a + (portableLog(b) - log_a) * numbers.uniform());
    }
    case Distribution::Kind::kNormal:
      return a + b * numbers.normal();
    case Distribution::Kind::kLogNormal:
      return portableExp(portableLog(a) + b * numbers.normal());
    case Distribution::Kind::kNone:
      break;
  }
  return 0.0;
}

void add(const Distribution& distribution, RandomNumbers numbers, double& x, double& y) {
  if (distribution.kind == Distribution::Kind::kNone) return;
  x += draw(distribution, numbers);
  y += draw(distribution, numbers);
}

/// Steps, or intervals between frames, that end at a time.
struct Division {
  double length;  ///< s
  double number;
};

/// Divides a duration into lengths that are as long as wanted, or else the next shorter ones.
Division divide(double duration, double wanted) {
  const double number = std::max(1.0, std::ceil(duration / wanted - 1e-9));
  const bool fits = std::abs(number * wanted - duration) <= 1e-9 * duration;
  return {fits ? wanted : duration / number, number};
}

/// As many steps as fit into a frame if such frames end at the duration, else the next smaller power of 2.
double stepsPerFrame(const Settings& settings, double time_step) {
  const double frame = std::min(settings.scenario.frame_interval, settings.duration);
  const double most = std::max(1.0, std::floor(frame / time_step + 1e-9));
  if (divide(settings.duration, most * time_step).length == most * time_step) return most;
  double power = 1.0;
  while (2.0 * power <= most) power *= 2.0;
  return power;
}

}  // namespace

// A shorter step may have room for more in a frame.
double fittedTimeStep(const Settings& settings, double time_step) {
  for (double longer = 0.0; longer != time_step;) {
    longer = time_step;
    const double steps = stepsPerFrame(settings, longer);
    const double frame = divide(settings.duration, steps * longer).length;
    if (frame != steps * longer) time_step = frame / steps;
  }
  return time_step;
}

std::vector<Option> caseOptions(Settings& s) {
  std::vector<Option> options = scenarioOptions(s.scenario);
  const auto of_one_run = [](const Option& option) {
    return std::find(std::begin(kOfOneRun), std::end(kOfOneRun), option.key) != std::end(kOfOneRun);
  };
  options.erase(std::remove_if(options.begin(), options.end(), of_one_run), options.end());
  const Option own[] = {{"duration", Number{&s.duration, Range::atLeast(0)}, "s",
                         "simulated time, in frames of frame_interval; 0: given by frames"},
                        {"mass_factor", Number{&s.mass_factor, Range::above(0)}, "",
                         "factor for the masses of the particle file"}};
  options.insert(options.end(), std::begin(own), std::end(own));
  return options;
}

std::int64_t Study::cases() const {
  std::int64_t cases = std::max<std::int64_t>(samples, 1);
  for (const Axis& axis : axes) {
    if (!axis.is_joined) cases *= static_cast<std::int64_t>(axis.values.size());
  }
  return cases;
}

Place Study::placeOf(std::int64_t index) const {
  Place place{std::vector<std::size_t>(axes.size()), 0};
  auto left = static_cast<std::size_t>(index);
  for (std::size_t i = axes.size(); i-- > 0;) {
    place.values[i] = left % axes[i].values.size();
    if (!axes[i].is_joined) left /= axes[i].values.size();
  }
  place.sample = static_cast<std::int64_t>(left);
  return place;
}

bool Study::changesParticles(const Settings& settings) const {
  return settings.mass_factor != 1.0 || mass_factor.kind != Distribution::Kind::kNone ||
         displacement.kind != Distribution::Kind::kNone ||
         velocity.kind != Distribution::Kind::kNone;
}

CaseMaker::CaseMaker(const Study& study) : study_(study), options_(caseOptions(case_.settings)) {
  for (const Axis& axis : study.axes) {
    varied_.push_back(&*std::find_if(options_.begin(), options_.end(),
                                     [&](const Option& option) { return option.key == axis.key; }));
  }
}

const Case& CaseMaker::make(std::int64_t index) {
  case_.settings = study_.base;
  case_.index = index;
  const Place place = study_.placeOf(index);
  case_.sample = place.sample;
  for (std::size_t i = 0; i < varied_.size(); ++i) {
    varied_[i]->assign(study_.axes[i].values[place.values[i]]);
  }
  setFrames();
  setParticles();
  return case_;
}

void CaseMaker::setFrames() {
  Scenario& scenario = case_.settings.scenario;
  const double duration = case_.settings.duration;
  if (duration == 0.0) return;
  double frame = scenario.frame_interval;
  if (scenario.method.get().hasFixedStep()) {
    const double fitted = fittedTimeStep(case_.settings, scenario.time_step);
    if (fitted != scenario.time_step) {
      throw InputError(
          fmt::format("time_step: whole steps must end at the duration, {} s, got {} s; "
                      "try {}",
                      numberText(duration), numberText(scenario.time_step), numberText(fitted)));
    }
    const double steps = stepsPerFrame(case_.settings, fitted);
    frame = steps * fitted;
    // Longer frames than 64 bits can count are refused with the other options.
    scenario.steps_per_frame = static_cast<std::int64_t>(std::min(steps, 9e18));
  }
  const Division frames = divide(duration, frame);
  scenario.frame_interval = frames.length;
  scenario.frames = static_cast<std::int64_t>(std::min(frames.number + 1.0, 9e18));
}

void CaseMaker::setParticles() {
  case_.particles = study_.particles.at(case_.settings.scenario.particles);
  if (!study_.changesParticles(case_.settings)) return;
  State& state = case_.particles.state;
  const auto sample = static_cast<std::uint64_t>(case_.sample);
  for (Eigen::Index i = 1; i < state.size(); ++i) {  // the mass of the fixed particle is not used
    const auto numbers_of = [&](std::uint32_t quantity) {
      return RandomNumbers(study_.seed, sample, static_cast<std::uint32_t>(i), quantity);
    };
    double& mass = case_.particles.masses[i];
    mass *= case_.settings.mass_factor;
    if (study_.mass_factor.kind != Distribution::Kind::kNone) {
      RandomNumbers numbers = numbers_of(kMass);
      mass *= draw(study_.mass_factor, numbers);
    }
    if (!std::isfinite(mass) || mass <= 0.0) {
      throw InputError(fmt::format("particle {}: mass must be positive and finite, got {}", i + 1,
                                   numberText(mass)));
    }
    add(study_.displacement, numbers_of(kDisplacement), state.x()[i], state.y()[i]);
    add(study_.velocity, numbers_of(kVelocity), state.vx()[i], state.vy()[i]);
  }
}

}  // namespace spring_pendulum::sweep

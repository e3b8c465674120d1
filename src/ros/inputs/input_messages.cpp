#include "ros/inputs/input_messages.hpp"

#include "base/numbers.hpp"
#include "io/files/text_file.hpp"
#include "simulation/options/option_set.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <map>
#include <utility>

namespace spring_pendulum {
namespace {

/// Whether the frames depend on an option besides the start: the method, all numbers, and where a run ends.
bool isRecorded(const Option& option) {
  return option.key == "on_divergence" || std::holds_alternative<Number>(option.value) ||
         std::holds_alternative<Count>(option.value) ||
         std::holds_alternative<MethodName>(option.value);
}

void addState(PendulumInput& message, const State& state, Eigen::Index i) {
  message.placed.push_back(static_cast<std::uint32_t>(i + 1));
  for (Eigen::Index c = 0; c < 4; ++c) message.states.push_back(state.values()(i, c));
}

/// Index of the particle with this number.
std::ptrdiff_t indexOf(std::uint32_t particle) {
  return static_cast<std::ptrdiff_t>(particle) - 1;
}

PlaneVector<double> vectorAt(const std::vector<double>& numbers, std::size_t k) {
  return {numbers[2 * k], numbers[2 * k + 1]};
}

void setScenario(Scenario& scenario, const PendulumInput& input) {
  OptionSet options(scenarioOptions(scenario));
  for (const Option& option : options.options()) {
    if (!isRecorded(option)) continue;
    const std::string start = fmt::format("{}=", option.key);
    const auto text =
        std::find_if(input.scenario.begin(), input.scenario.end(),
                     [&](const std::string& each) { return each.rfind(start, 0) == 0; });
    if (text == input.scenario.end()) throw InputError(fmt::format("has no {}", option.key));
    options.set(option, text->substr(start.size()), std::string(option.key));
  }
  checkScenario(scenario);
}

void setStates(State& state, const PendulumInput& input) {
  for (std::size_t k = 0; k < input.placed.size(); ++k) {
    const std::ptrdiff_t i = indexOf(input.placed[k]);
    if (i < 0 || i >= state.size()) throw InputError("a particle does not exist");
    for (Eigen::Index c = 0; c < 4; ++c) {
      state.values()(i, c) = input.states[4 * k + static_cast<std::size_t>(c)];
    }
  }
}

Drive driveOf(const PendulumInput& input) {
  Drive drive;
  for (std::size_t k = 0; k < input.held.size(); ++k) {
    drive.held.push_back({indexOf(input.held[k]), vectorAt(input.accelerations, k)});
  }
  for (std::size_t k = 0; k < input.pushed.size(); ++k) {
    drive.forces.push_back({indexOf(input.pushed[k]), vectorAt(input.forces, k)});
  }
  return drive;
}

}  // namespace

PendulumInput InputLog::messageOf(const Run& run, double time) {
  PendulumInput message;
  message.began = began_;
  message.number = count_++;
  message.time = time;
  message.frame = run.frame();
  message.display_interval = display_interval_;
  Scenario scenario = run.scenario();
  for (const Option& option : scenarioOptions(scenario)) {
    if (isRecorded(option))
      message.scenario.push_back(fmt::format("{}={}", option.key, option.text()));
  }
  for (const auto& [particle, acceleration] : run.chain().drive().held) {
    message.held.push_back(static_cast<std::uint32_t>(particle + 1));
    message.accelerations.insert(message.accelerations.end(), {acceleration.x, acceleration.y});
  }
  for (const auto& [particle, force] : run.chain().drive().forces) {
    message.pushed.push_back(static_cast<std::uint32_t>(particle + 1));
    message.forces.insert(message.forces.end(), {force.x, force.y});
  }
  return message;
}

void InputLog::started(const Run& run, double time) {
  PendulumInput message = messageOf(run, time);
  message.start = 1;
  for (Eigen::Index i = 0; i < run.state().size(); ++i) addState(message, run.state(), i);
  const auto masses = run.chain().masses();
  message.masses.assign(masses.data(), masses.data() + masses.size());
  sink_(message);
}

void InputLog::changed(const Run& run, const State& before) {
  PendulumInput message = messageOf(run, run.time());
  for (Eigen::Index i = 0; i < before.size(); ++i) {
    for (Eigen::Index c = 0; c < 4; ++c) {  // also another sign of 0 is another state
      const double old = before.values()(i, c), now = run.state().values()(i, c);
      if (std::memcmp(&old, &now, sizeof(now)) == 0) continue;
      addState(message, run.state(), i);
      break;
    }
  }
  sink_(message);
}

void InputLog::ended(const Run& run) {
  PendulumInput message = messageOf(run, run.time());
  message.end = 1;
  sink_(message);
}

Replay::Replay(const std::string& path) : path_(path) {
  std::map<std::uint32_t, PendulumInput::ConstPtr>
      inputs;  // by number: a late recorder gets some twice
  std::int64_t size = 0;
  openTextFile(path, size);  // refuses pipes, which would block
  try {
    const rosbag::Bag bag(path, rosbag::bagmode::Read);
    std::string topic;
    rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::datatype<PendulumInput>()));
    for (const rosbag::MessageInstance& message : view) {
      const auto input = message.instantiate<PendulumInput>();
      if (!input) throw InputError(fmt::format("{}: has inputs of another version", path));
      if (topic.empty()) topic = message.getTopic();
      if (message.getTopic() != topic) {
        throw InputError(fmt::format("{}: has the inputs of several runs: {} and {}", path, topic,
                                     message.getTopic()));
      }
      if (!inputs.empty() && input->began < inputs.begin()->second->began) continue;
      if (!inputs.empty() && input->began > inputs.begin()->second->began) inputs.clear();
      inputs.emplace(input->number, input);
    }
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // a damaged bag; rosbag throws many kinds
    throw FileError(fmt::format("{}: cannot be read as a bag: {}", path, error.what()));
  }
  for (const auto& [number, input] : inputs) {
    check(*input);
    inputs_.push_back(*input);
  }
  if (inputs_.empty()) {
    throw InputError(fmt::format("{}: has no inputs; record the topic inputs of a node", path));
  }
}

void Replay::refuse(const PendulumInput& input, const std::string& reason) const {
  throw InputError(fmt::format("{}: input {}: {}", path_, input.number, reason));
}

void Replay::check(const PendulumInput& input) const {
  if (input.number != inputs_.size()) {
    throw InputError(fmt::format("{}: input {} is missing; record from the start of the node on",
                                 path_, inputs_.size()));
  }
  bool complete = (input.number > 0 || input.start != 0) && std::isfinite(input.time) &&
                  input.display_interval >= 0.0 &&
                  input.accelerations.size() == 2 * input.held.size() &&
                  input.forces.size() == 2 * input.pushed.size() &&
                  input.states.size() == 4 * input.placed.size();
  if (input.start != 0) {  // has all particles
    complete = complete && input.masses.size() == input.placed.size() &&
               (input.number == 0 || input.masses == inputs_.front().masses);
    for (std::size_t i = 0; i < input.placed.size(); ++i) {
      complete = complete && input.placed[i] == i + 1;
    }
  }
  if (!complete) refuse(input, "is not complete");
  if (!inputs_.empty() && inputs_.back().end != 0) refuse(input, "comes after the end");
}

Particles Replay::begin(Scenario& scenario) const {
  const PendulumInput& first = inputs_.front();
  try {
    scenario.start = Start::kFile;
    setScenario(scenario, first);
    const auto size = static_cast<std::ptrdiff_t>(first.masses.size());
    Particles particles{AlignedNumbers(size), State(size), first.frame};
    std::copy(first.masses.begin(), first.masses.end(), particles.masses.data());
    setStates(particles.state, first);
    Scenario copy = scenario;
    copy.reference = ReferenceUse::kNever;
    const Run run(copy, particles);  // refuses what no run can start with
    return particles;
  } catch (const InputError& error) {
    refuse(first, error.what());
  }
}

bool Replay::apply(Run& run) {
  for (; next_ < inputs_.size() && inputs_[next_].time <= run.time(); ++next_) {
    const PendulumInput& input = inputs_[next_];
    if (input.end != 0) return false;
    try {
      if (input.time != run.time()) {
        throw InputError(
            fmt::format("acted at t = {} s, where this run has no state", numberText(input.time)));
      }
      Scenario scenario = run.scenario();
      setScenario(scenario, input);
      State state = run.state();
      setStates(state, input);
      run.change(scenario, driveOf(input), state);
      if (input.start != 0) run.goTo(input.frame, state);
    } catch (const InputError& error) {
      refuse(input, error.what());
    }
    if (input.start != 0) {
      ++next_;
      return true;
    }
  }
  return false;
}

bool Replay::isOver(const Run& run) const {
  return next_ + 1 == inputs_.size() && inputs_.back().end != 0 &&
         inputs_.back().time <= run.time();
}

std::string Replay::missing() const {
  if (inputs_.back().end != 0) return "";
  return path_ + ": has no closing input, so the last inputs may be missing";
}

std::string Replay::unreached() const {
  if (next_ == inputs_.size() || inputs_[next_].end != 0) return "";
  return fmt::format("{}: the run ended before input {} at t = {} s", path_, next_,
                     numberText(inputs_[next_].time));
}

}  // namespace spring_pendulum

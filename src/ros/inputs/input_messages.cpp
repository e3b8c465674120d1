#include "ros/inputs/input_messages.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <utility>

namespace spring_pendulum {
namespace {

/// Whether the frames depend on an option besides the start: the method, all numbers, and where a run ends.
bool isRecorded(const Option& option) {
  return option.key == "on_divergence" || option.key == "method" || option.isNumber();
}

void addState(PendulumInput& message, const State& state, Eigen::Index i) {
  message.placed.push_back(static_cast<std::uint32_t>(i + 1));
  for (Eigen::Index c = 0; c < 4; ++c) message.states.push_back(state.values()(i, c));
}

void setScenario(Scenario& scenario, const PendulumInput& input) {
  OptionSet options(scenarioOptions(scenario));
  auto text = input.scenario.begin();
  for (const Option& option : options.options()) {
    if (!isRecorded(option)) continue;
    const std::string start = fmt::format("{}=", option.key);
    if (text == input.scenario.end() || text->rfind(start, 0) != 0)
      throw InputError(fmt::format("has no {}", option.key));
    options.set(option, (text++)->substr(start.size()), std::string(option.key));
  }
  checkScenario(scenario);
}

void setStates(State& state, const PendulumInput& input) {
  for (std::size_t k = 0; k < input.placed.size(); ++k) {
    const std::ptrdiff_t i = input.placed[k] - std::ptrdiff_t{1};
    if (i < 0 || i >= state.size()) throw InputError("a particle does not exist");
    for (Eigen::Index c = 0; c < 4; ++c)
      state.values()(i, c) = input.states[4 * k + static_cast<std::size_t>(c)];
  }
}

Drive driveOf(const PendulumInput& input) {
  Drive drive;
  for (std::size_t k = 0; k < input.held.size(); ++k) {
    const double* const at = &input.accelerations[2 * k];
    drive.held.push_back({input.held[k] - std::ptrdiff_t{1}, {at[0], at[1]}});
  }
  for (std::size_t k = 0; k < input.pushed.size(); ++k) {
    const double* const at = &input.forces[2 * k];
    drive.forces.push_back({input.pushed[k] - std::ptrdiff_t{1}, {at[0], at[1]}});
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
  Scenario scenario{run.plan(), run.chain().constants()};
  for (const Option& option : scenarioOptions(scenario))
    if (isRecorded(option))
      message.scenario.push_back(fmt::format("{}={}", option.key, option.text()));
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

void InputLog::changed(const Run& run, const State& before, double time) {
  PendulumInput message = messageOf(run, time);
  for (Eigen::Index i = 0; i < before.size(); ++i) {
    const Eigen::RowVector4d old = before.values().row(i), now = run.state().values().row(i);
    // Also another sign of 0 is another state.
    if (std::memcmp(old.data(), now.data(), 4 * sizeof(double)) != 0)
      addState(message, run.state(), i);
  }
  sink_(message);
}

void InputLog::ended(const Run& run) {
  PendulumInput message = messageOf(run, run.time());
  message.end = 1;
  sink_(message);
}

Replay::Replay(const std::string& path) : path_(path) {
  std::int64_t size = 0;
  openTextFile(path, size);  // refuses pipes, which would block
  try {
    bag_.open(path, rosbag::bagmode::Read);
    find();
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // a damaged bag; rosbag throws many kinds
    throw FileError(fmt::format("{}: cannot be read as a bag: {}", path, error.what()));
  }
  if (places_.empty())
    throw InputError(path + ": has no inputs; record the topic inputs of a node");
  std::uint32_t number = 0;
  for (const auto& place : places_) {
    if (place.first == number++) continue;
    throw InputError(fmt::format("{}: input {} is missing; record from the start of the node on",
                                 path, number - 1));
  }
  if (end_ && *end_ + 1 != number)
    throw InputError(fmt::format("{}: input {}: comes after the end", path, *end_ + 1));
  place_ = places_.begin();
  first_ = read();
  next_ = read();
}

void Replay::find() {
  ros::Time began;
  std::string topic;
  rosbag::View view(bag_, rosbag::TypeQuery(ros::message_traits::datatype<PendulumInput>()));
  for (const rosbag::MessageInstance& message : view) {
    const auto input = message.instantiate<PendulumInput>();
    if (!input) throw InputError(fmt::format("{}: has inputs of another version", path_));
    if (topic.empty()) topic = message.getTopic();
    if (message.getTopic() != topic)
      throw InputError(fmt::format("{}: has the inputs of several runs: {} and {}", path_, topic,
                                   message.getTopic()));
    if (input->began < began) continue;
    if (input->began > began) {
      places_.clear();
      end_.reset();
    }
    began = input->began;
    check(*input);
    places_.emplace(input->number, message);
    if (input->end != 0) end_ = std::min(end_.value_or(input->number), input->number);
  }
}

PendulumInput::ConstPtr Replay::read() {
  if (place_ == places_.end()) return nullptr;
  try {
    return (place_++)->second.instantiate<PendulumInput>();
  } catch (const std::exception& error) {
    throw FileError(fmt::format("{}: cannot be read as a bag: {}", path_, error.what()));
  }
}

void Replay::refuse(const PendulumInput& input, const std::string& reason) const {
  throw InputError(fmt::format("{}: input {}: {}", path_, input.number, reason));
}

void Replay::check(const PendulumInput& input) const {
  bool complete = (input.number > 0 || input.start != 0) && std::isfinite(input.time) &&
                  input.display_interval >= 0.0 &&
                  input.accelerations.size() == 2 * input.held.size() &&
                  input.forces.size() == 2 * input.pushed.size() &&
                  input.states.size() == 4 * input.placed.size();
  if (input.start != 0) {  // has all particles
    complete = complete && input.masses.size() == input.placed.size();
    for (std::size_t i = 0; i < input.placed.size(); ++i)
      complete = complete && input.placed[i] == i + 1;
  }
  if (!complete) refuse(input, "is not complete");
  if (input.number == 0 && input.held.size() + input.pushed.size() > 0)
    refuse(input, "nothing can act on the start itself: it needs an input of its own");
}

Scene Replay::begin(Scenario& scenario) const {
  try {
    scenario.start = Start::kFile;
    setScenario(scenario, *first_);
    const auto size = static_cast<std::ptrdiff_t>(first_->masses.size());
    Scene scene{AlignedNumbers(size), State(size), first_->frame, scenario.constants};
    std::copy(first_->masses.begin(), first_->masses.end(), scene.masses.data());
    setStates(scene.state, *first_);
    Plan plan = scenario;
    plan.reference = ReferenceUse::kNever;
    const Run run(scene, plan);  // refuses what no run can start with
    return scene;
  } catch (const InputError& error) {
    refuse(*first_, error.what());
  }
}

bool Replay::apply(Run& run) {
  while (next_ && next_->end == 0 && next_->time <= run.time()) {
    const PendulumInput::ConstPtr input = std::exchange(next_, read());
    try {
      act(*input, run);
    } catch (const InputError& error) {
      refuse(*input, error.what());
    }
    if (input->start != 0) return true;
  }
  return false;
}

void Replay::act(const PendulumInput& input, Run& run) const {
  if (input.time != run.time())
    throw InputError(
        fmt::format("acted at t = {} s, where this run has no state", numberText(input.time)));
  if (input.start != 0 && input.masses != first_->masses) throw InputError("has other masses");
  Scenario scenario{run.plan(), run.chain().constants()};
  setScenario(scenario, input);
  State state = run.state();
  setStates(state, input);
  if (input.start != 0) run.reset();  // methods may change at a frame only
  run.change(scenario, scenario.constants, driveOf(input), state);
  if (input.start != 0) run.goTo(input.frame, state);
}

std::string Replay::missing() const {
  return end_ ? "" : path_ + ": has no closing input, so the last inputs may be missing";
}

std::string Replay::unreached() const {
  if (!next_ || next_->end != 0) return "";
  return fmt::format("{}: the run ended before input {} at t = {} s", path_, next_->number,
                     numberText(next_->time));
}

}  // namespace spring_pendulum

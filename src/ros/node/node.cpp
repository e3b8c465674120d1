#include "ros/node/node.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/files/touched_files.hpp"
#include "io/formats/state_file.hpp"
#include "io/program/program.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

constexpr double kShowAgainInterval = 0.5;  // s, of a run that does not advance
constexpr double kLongestService = 0.1;     // s, between two looks at signals
constexpr double kLoopPause = 1.0;          // s, pause at the last frame before a loop
constexpr double kLastMessages = 0.5;       // s, for connecting to late subscribers at the end
constexpr double kLargestSpeed = 1e9;
/// A subscriber that comes later than this number of inputs, or bytes of them, misses some.
constexpr std::uint32_t kMostInputs = 20000;
constexpr std::size_t kMostBytes = 32'000'000;
constexpr const char* kDefaultStateFile = "pendulum_state.txt";

/// Whether neither ROS nor a signal has ended the program.
bool isWanted() {
  return ros::ok() && interruption() == 0;
}

/// Unlike ros::Time, it differs for each run, also with use_sim_time.
ros::Time wallClock() {
  const ros::WallTime now = ros::WallTime::now();
  return {now.sec, now.nsec};
}

}  // namespace

Node::Node(ros::NodeHandle& node, ros::NodeHandle& private_node,
           const NodeConfiguration& configuration, const Scene& scene)
    : options_(configuration.options),
      scenario_(configuration.scenario),
      run_(scene, scenario_,
           {options_.track_dissipation || !scenario_.energy.empty(), options_.displayInterval(),
            interruption}),
      publisher_(node, run_, options_),
      pacer_(options_.real_time_factor, options_.display_rate),
      inputs_(node.advertise<PendulumInput>("inputs", kMostInputs,
                                            [this](const ros::SingleSubscriberPublisher& late) {
                                              for (const auto& input : sent_) late.publish(input);
                                            })),
      input_log_(options_.displayInterval(), wallClock(),
                 [this](const PendulumInput& input) { record(input); }),
      driver_(run_, &input_log_),
      frames_(options_.frame_id),
      handles_(node, run_, options_, driver_, frames_,
               [this](const Request& request) { return take(request); }),
      robots_(node, run_, options_, driver_, frames_),
      services_(advertiseServices(private_node, frames_,
                                  [this](const Request& request) { return take(request); })),
      files_(run_, scenario_),
      log_(run_, files_, publisher_, options_.at_end == AtEnd::kHold),
      values_(configuration.values) {
  if (!options_.follow.empty()) {
    leader_ = node.subscribe(options_.follow, 100, &Node::onLeaderState, this);
  }
}

void Node::record(PendulumInput input) {
  input.header.stamp = input_stamps_.next(input.time);
  input.header.frame_id = options_.frame_id;
  inputs_.publish(input);
  sent_bytes_ += ros::serialization::serializationLength(input);
  if (sent_.size() < kMostInputs && sent_bytes_ < kMostBytes) sent_.push_back(std::move(input));
}

void Node::spin() {
  logStart(run_, scenario_, options_, files_);
  ROS_INFO_STREAM("parameters: " << values_);
  run_.advance();
  input_log_.started(run_, run_.time());
  catchInterruptions();  // from now on ROS continues after a signal until the files are closed
  publisher_.waitForSubscribers(options_);
  pacer_.start(run_.time(), ros::SteadyTime::now());
  finishState();
  while (isWanted() && !isAtExit()) {
    serve();
    if (!isWanted()) break;
    if (isDue()) {
      advance();
    } else if (isLoopDue()) {
      goTo(nullptr);
    } else if ((run_.isOver() || paused_) && ros::SteadyTime::now() >= show_at_) {
      if (paused_) change(run_.nextTime(), true);
      show();
    }
  }
  end();
}

void Node::end() {
  ended_ = true;
  input_log_.ended(run_);
  files_.finish();
  log_.finish();
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(kLastMessages);
  while (isWanted() && ros::SteadyTime::now() < end) {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1 * kLastMessages));
  }
  publisher_.clear();
  if (ros::ok()) ros::WallDuration(0.2 * kLastMessages).sleep();
}

bool Node::isAtExit() const {
  return run_.isOver() && options_.at_end == AtEnd::kExit;
}

bool Node::isLoopDue() const {
  return run_.isOver() && !paused_ && options_.at_end == AtEnd::kLoop &&
         (ros::SteadyTime::now() - over_since_).toSec() >= kLoopPause;
}

bool Node::isDue() const {
  if (run_.isOver()) return false;
  if (paused_) return steps_wanted_ > 0;
  if (!options_.follow.empty()) return run_.nextTime() <= leader_time_;
  return ros::SteadyTime::now() >= pacer_.dueTime(run_.nextTime());
}

void Node::serve() {
  auto* callbacks = ros::getGlobalCallbackQueue();
  callbacks->callAvailable();
  if (isDue() || isAtExit()) return;
  double wait = kLongestService;
  if (run_.isOver() || paused_) {
    wait = std::min(wait, (show_at_ - ros::SteadyTime::now()).toSec());
  } else if (options_.follow.empty()) {
    wait = std::min(wait, (pacer_.dueTime(run_.nextTime()) - ros::SteadyTime::now()).toSec());
  }
  if (wait > 0.0) callbacks->callAvailable(ros::WallDuration(wait));
}

void Node::advance() {
  if (steps_wanted_ > 0) --steps_wanted_;
  const bool is_late =
      options_.follow.empty() && pacer_.isLate(run_.nextTime(), ros::SteadyTime::now());
  if (paused_ || is_late || !publisher_.isWatched()) {
    change(run_.nextFrameTime(), false);
    run_.advance();
  } else {
    change(run_.nextTime(), false);
    run_.advancePart();
    // Inside a frame nobody would call this a divergence.
    if (!run_.isFinite()) run_.advance();
  }
  finishState();
}

void Node::change(double next_time, bool paused) {
  handles_.releaseSilent();
  robots_.follow(options_.real_time_factor);
  try {
    driver_.apply(run_, next_time, paused);
  } catch (const InputError& error) {
    if (refusals_.isDue()) ROS_ERROR_STREAM("refused: " << error.what());
  }
}

void Node::goTo(const Scene* to) {
  handles_.reset();
  driver_.reset(run_, to);
  robots_.reset();
  steps_wanted_ = 0;
  pacer_ = Pacer(options_.real_time_factor, options_.display_rate);
  run_.advance();
  pacer_.start(run_.time(), ros::SteadyTime::now());
  finishState();
}

void Node::finishState() {
  if (run_.wasStopped()) return;  // inside a frame, which is discarded
  const ros::SteadyTime now = ros::SteadyTime::now();
  pacer_.reached(run_.time(), now);
  if (run_.isAtFrame() && run_.isShown() && run_.isFinite()) {
    last_frame_ = run_.state();
    last_frame_number_ = run_.frame();
  }
  files_.write(run_);
  if (run_.isOver()) {
    files_.finish();
    over_since_ = now;
  }
  show();
  show_at_ = now;
}

void Node::show() {
  show_at_ = ros::SteadyTime::now() + ros::WallDuration(kShowAgainInterval);
  publisher_.freezeCamera(handles_.isGrabbed());  // it must not move under the mouse
  const auto header = publisher_.publish(run_, showing());
  if (header && run_.isFinite()) {
    handles_.show();
    robots_.show(*header);
  }
  log_.update();
}

Showing Node::showing() {
  // A follower shows what its leader has shown last, also if several states are due at once.
  const bool shown =
      paused_ || run_.isOver() ||
      (options_.follow.empty() ? pacer_.isShown(run_.time()) : run_.nextTime() > leader_time_);
  std::string speed;
  if (run_.isOver()) {
    speed = run_.isShown() ? "finished" : "stopped";
  } else if (paused_) {
    speed = "paused";
  } else if (pacer_.speed() > 0.0) {
    speed = fmt::format("{:.2f} x real time", pacer_.speed());
  }
  return {paused_, speed, shown};
}

std::string Node::take(const Request& request) {
  if (ended_) throw InputError("the node is ending");
  std::string sentence = std::visit([this](const auto& each) { return on(each); }, request);
  show_at_ = ros::SteadyTime::now();
  return sentence;
}

std::string Node::overMessage() const {
  return fmt::format("the run ended at frame {}{}; call ~reset to start it again", run_.frame(),
                     run_.isShown() ? "" : ", because the motion diverged");
}

std::string Node::on(const Pause& request) {
  if (run_.isOver() && options_.at_end != AtEnd::kLoop) throw InputError(overMessage());
  const bool paused = request.paused.value_or(!paused_);
  std::string sentence =
      fmt::format("{}{} at frame {}, t = {:.6g} s", paused == paused_ ? "already " : "",
                  paused ? "paused" : "running", run_.frame(), run_.time());
  if (paused == paused_) return sentence;
  paused_ = paused;
  steps_wanted_ = 0;
  pacer_.start(run_.time(), ros::SteadyTime::now());
  return sentence;
}

std::string Node::on(const Step& /*request*/) {
  if (run_.isOver()) throw InputError(overMessage());
  if (!paused_) throw InputError("the run is not paused; call ~pause first");
  ++steps_wanted_;
  return fmt::format("advancing to frame {}", run_.frame() + steps_wanted_);
}

std::string Node::on(const Reset& /*request*/) {
  std::string sentence =
      fmt::format("back to frame 0 from frame {}{}", run_.frame(), paused_ ? ", paused" : "");
  goTo(nullptr);
  return sentence;
}

std::string Node::on(const SaveState& request) {
  if (last_frame_.size() == 0) throw InputError("the run has not started yet");
  const std::string path = request.file.empty() ? kDefaultStateFile : request.file;
  TouchedFiles touched = touchedFiles(scenario_, "");
  touched.outputs.push_back(path);
  checkTouchedFiles(touched);
  const double time = run_.plan().timeOfFrame(last_frame_number_);
  writeStateFile(path, run_.chain(), last_frame_, last_frame_number_, time);
  std::string sentence =
      fmt::format("frame {}, t = {:.6g} s, is in {}", last_frame_number_, time, fullPath(path));
  ROS_INFO_STREAM(sentence);
  return sentence;
}

std::string Node::on(const LoadState& request) {
  if (last_frame_.size() == 0) throw InputError("the run has not started yet");
  Scenario scenario = scenario_;
  static_cast<Plan&>(scenario) = run_.plan();
  scenario.particles = request.file.empty() ? kDefaultStateFile : request.file;
  const Scene loaded = readStateFile(scenario);
  if (loaded.masses.size() != run_.chain().size() ||
      loaded.masses.view() != run_.chain().masses()) {
    throw InputError(
        fmt::format("{}: is the state of another chain: the masses differ", scenario.particles));
  }
  checkFirstFrame(scenario, loaded.frame);
  goTo(&loaded);
  return fmt::format("to frame {} of {}", loaded.frame, fullPath(scenario.particles));
}

std::string Node::on(const SetConstant& request) {
  if (request.name != "real_time_factor") return driver_.on(request);
  NodeOptions options = options_;
  OptionSet all(playOptions(options));
  all.set(all.find(request.name, "set"), request.value, request.name);
  if (options.real_time_factor > kLargestSpeed) {
    throw InputError(fmt::format("real_time_factor: must be at most {:g}", kLargestSpeed));
  }
  options_ = options;
  pacer_ = Pacer(options_.real_time_factor, options_.display_rate);
  pacer_.start(run_.time(), ros::SteadyTime::now());
  return fmt::format("real_time_factor is {}", numberText(options_.real_time_factor));
}

void Node::onLeaderState(const PendulumState::ConstPtr& state) {
  const bool went_back = state->time < (1.0 - 1e-9) * leader_time_;
  leader_time_ = state->time;
  if (went_back && !ended_) goTo(nullptr);
}

}  // namespace spring_pendulum

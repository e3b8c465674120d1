#include "ros/node/player.hpp"

#include "io/program/interruption.hpp"
#include "ros/inputs/answer.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>

namespace spring_pendulum {
namespace {

constexpr double kShowAgainInterval = 0.5;  // s, while the run is paused
constexpr double kLongestWait = 0.1;        // s, latency of the end of ROS
constexpr double kLoopPause = 1.0;          // s, pause at the last frame before a loop

/// Whether neither ROS nor a signal has ended the program.
bool isWanted() {
  return ros::ok() && interruption() == 0;
}

}  // namespace

Player::Player(ros::NodeHandle& node, ros::NodeHandle& private_node, const Run& run,
               const NodeOptions& options)
    : run_(run), options_(options), pacer_(options.real_time_factor, options.display_rate) {
  pause_ = private_node.advertiseService("pause", &Player::onPause, this);
  step_ = private_node.advertiseService("step", &Player::onStep, this);
  reset_ = private_node.advertiseService("reset", &Player::onReset, this);
  if (!options.follow.empty()) {
    leader_ = node.subscribe(options.follow, 100, &Player::onLeaderState, this);
  }
}

Player::Action Player::next() {
  if (!pacer_.isStarted()) pacer_.start(run_.time(), ros::SteadyTime::now());
  pacer_.note(run_.time(), ros::SteadyTime::now());
  while (isWanted()) {
    serveUntilDue();
    if (!isWanted()) break;
    const ros::SteadyTime now = ros::SteadyTime::now();
    if (reset_wanted_) return goBack();
    if (isDue()) {
      stands_since_ = ros::SteadyTime();
      if (steps_wanted_ > 0) --steps_wanted_;
      const bool hurry =
          paused_ || (options_.follow.empty() && pacer_.isLate(run_.nextTime(), now));
      return hurry ? Action::kAdvanceFrame : Action::kAdvance;
    }
    if (isAtExit()) return Action::kQuit;
    if (!run_.isOver() && !paused_) continue;
    if (touched_) {
      touched_ = false;
      stands_since_ = last_shown_ = now;
      return Action::kShowAgain;
    }
    if (stands_since_.isZero()) {
      stands_since_ = last_shown_ = now;
      return Action::kShowAgain;
    }
    if (run_.isOver() && options_.at_end == AtEnd::kLoop &&
        (now - stands_since_).toSec() >= kLoopPause) {
      return goBack();
    }
    if ((now - last_shown_).toSec() < kShowAgainInterval) continue;
    last_shown_ = now;
    return Action::kShowAgain;
  }
  return Action::kQuit;
}

Player::Action Player::goBack() {
  reset_wanted_ = false;
  steps_wanted_ = 0;
  stands_since_ = ros::SteadyTime();
  pacer_ = Pacer(options_.real_time_factor, options_.display_rate);  // starts at the new time
  return Action::kReset;
}

bool Player::isDue() const {
  if (run_.isOver()) return false;
  if (paused_) return steps_wanted_ > 0;
  if (!options_.follow.empty()) return run_.nextTime() <= leader_time_;
  return ros::SteadyTime::now() >= pacer_.dueTime(run_.nextTime());
}

Showing Player::showing() {
  const bool is_paced = options_.follow.empty() && !paused_ && !run_.isOver();
  return {paused_, pace(), !is_paced || pacer_.isShown(run_.time())};
}

void Player::serveUntilDue() {
  auto* callbacks = ros::getGlobalCallbackQueue();
  callbacks->callAvailable();
  if (reset_wanted_ || isDue() || isAtExit()) return;
  double wait = kLongestWait;
  if (!run_.isOver() && !paused_ && options_.follow.empty()) {
    wait = std::min(wait, (pacer_.dueTime(run_.nextTime()) - ros::SteadyTime::now()).toSec());
  }
  if (wait > 0.0) callbacks->callAvailable(ros::WallDuration(wait));
}

bool Player::isAtExit() const {
  return run_.isOver() && options_.at_end == AtEnd::kExit;
}

/// Speed of the run: "1.00 x real time"
std::string Player::pace() const {
  if (run_.isOver()) return run_.isShown() ? "finished" : "stopped";
  if (paused_) return "paused";
  return pacer_.speed() > 0.0 ? fmt::format("{:.2f} x real time", pacer_.speed()) : "";
}

std::string Player::overMessage() const {
  return fmt::format("the run ended at frame {}{}; call ~reset to start it again", run_.frame(),
                     run_.isShown() ? "" : ", because the motion diverged");
}

std::string Player::pause(bool paused) {
  std::string sentence =
      fmt::format("{}{} at frame {}, t = {:.6g} s", paused == paused_ ? "already " : "",
                  paused ? "paused" : "running", run_.frame(), run_.time());
  if (paused == paused_) return sentence;
  paused_ = paused;
  steps_wanted_ = 0;
  stands_since_ = ros::SteadyTime();
  pacer_.start(run_.time(), ros::SteadyTime::now());
  return sentence;
}

void Player::setSpeed(double real_time_factor) {
  options_.real_time_factor = real_time_factor;
  pacer_ = Pacer(real_time_factor, options_.display_rate);
  pacer_.start(run_.time(), ros::SteadyTime::now());
}

std::string Player::step() {
  ++steps_wanted_;
  return fmt::format("advancing to frame {}", run_.frame() + steps_wanted_);
}

void Player::goTo(Particles particles) {
  wanted_ = std::move(particles);
  reset_wanted_ = true;
}

std::string Player::reset() {
  wanted_.reset();
  reset_wanted_ = true;
  return fmt::format("back to frame 0 from frame {}{}", run_.frame(), paused_ ? ", paused" : "");
}

bool Player::onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  return answer(response, [&] {
    if (run_.isOver() && options_.at_end != AtEnd::kLoop) throw InputError(overMessage());
    return pause(request.data != 0);
  });
}

bool Player::onStep(TriggerRequest&, TriggerResponse& response) {
  return answer(response, [this] {
    if (run_.isOver()) throw InputError(overMessage());
    if (!paused_) throw InputError("the run is not paused; call ~pause first");
    return step();
  });
}

bool Player::onReset(TriggerRequest&, TriggerResponse& response) {
  return answer(response, [this] { return reset(); });
}

void Player::onLeaderState(const PendulumState::ConstPtr& state) {
  if (state->time < leader_time_) reset_wanted_ = true;
  leader_time_ = state->time;
}

}  // namespace spring_pendulum

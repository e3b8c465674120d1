#include "ros/node/node.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/program/program.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/outcome.hpp>

#include <fmt/format.h>

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <utility>

namespace spring_pendulum {

constexpr double kShowAgainInterval = 0.5;  // s, of a run that does not advance
constexpr double kLongestService = 0.1;     // s, between two looks at signals
constexpr double kLongFrame = 1.0;          // s, which is computed state by state
constexpr double kLongestGap = 0.1;         // s, between the states of a run that is late
constexpr double kLastMessages = 0.5;       // s, for connecting to late subscribers at the end
constexpr double kLongestSending = 10.0;    // s, at the end, for subscribers that are slower
constexpr double kSettling = 1.0 / 30.0;    // s, of a particle that follows its target
constexpr double kPollInterval = 0.01;      // s between two checks for subscribers
/// A subscriber that comes later than this number of inputs, or bytes of them, misses some.
constexpr std::uint32_t kMostInputs = 20000;
constexpr std::size_t kMostBytes = 32'000'000;

Node::Node(Scenario scenario, NodeOptions options, Run& run, RunFiles& files)
    : options_(std::move(options)),
      scenario_(std::move(scenario)),
      run_(run),
      files_(files),
      publisher_(node_, run_, options_),
      pacer_(options_.real_time_factor, options_.display_rate),
      inputs_(node_.advertise<PendulumInput>("inputs", kMostInputs,
                                             [this](const ros::SingleSubscriberPublisher& late) {
                                               for (const auto& input : sent_) late.publish(input);
                                             })),
      // Unlike ros::Time, the wall clock differs for each run, also with use_sim_time.
      input_log_(options_.displayInterval(), ros::Time().fromNSec(ros::WallTime::now().toNSec()),
                 [this](const PendulumInput& input) { record(input); }),
      driver_(run_, &input_log_, kSettling * options_.real_time_factor),
      frames_(options_.frame_id),
      handles_(node_, run_, options_, driver_, frames_,
               [this](const Request& request) { return take(request); }),
      robots_(node_, run_, options_, driver_, frames_),
      services_(advertiseServices()) {}

void Node::record(PendulumInput input) {
  input.header.stamp = input_stamps_.next(input.time);
  input.header.frame_id = options_.frame_id;
  inputs_.publish(input);
  if (sent_.size() < kMostInputs && sent_bytes_ < kMostBytes) sent_.push_back(input);
  sent_bytes_ += ros::serialization::serializationLength(input);
}

int Node::spin() {
  logStart();
  run_.advance();
  input_log_.started(run_, run_.time());
  waitForSubscribers();
  pacer_.start(run_.time(), ros::SteadyTime::now());
  finishState();
  while (interruption() == 0 && !(run_.isOver() && options_.at_end == AtEnd::kExit)) {
    serve();
    if (interruption() != 0) break;
    if (isDue()) {
      advance();
    } else if ((run_.isOver() || paused_) && ros::SteadyTime::now() >= show_at_) {
      if (paused_) change(run_.time(), true);
      show();
    }
  }
  end();
  return run_.verdict().kind == VerdictKind::kDiverged ? kDiverged : kDone;
}

void Node::waitForSubscribers() {
  const std::int64_t wanted = options_.wait_for_subscribers;
  const auto present = [this] { return publisher_.subscribers(options_.wait_for_nodes); };
  if (present() >= wanted) return;
  const std::string text = "waiting for " + counted(wanted, "subscriber");
  ROS_INFO_STREAM(text << " of markers, state and status (wait_for_subscribers)");
  publisher_.publishWaiting(text);
  const double timeout =
      std::min(options_.wait_timeout > 0.0 ? options_.wait_timeout : kLongestWait, kLongestWait);
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(timeout);
  while (interruption() == 0 && present() < wanted) {
    callBack(kPollInterval);
    if (ros::SteadyTime::now() < end) continue;
    ROS_WARN_STREAM(
        fmt::format("only {} of {} subscribers after {:.6g} s (wait_timeout): starting anyway",
                    present(), wanted, timeout));
    return;
  }
}

void Node::end() {
  ended_ = true;
  input_log_.ended(run_);
  files_.finish();
  // The line of a run that did not reach its end, or continued after it.
  if (logged_.frames != run_.shownFrames()) ROS_INFO_STREAM(closingLine());
  const auto wait = [this](double least, double most) {
    const int before = interruption();
    const ros::SteadyTime start = ros::SteadyTime::now();
    const auto lasts = [&](double s) { return (ros::SteadyTime::now() - start).toSec() < s; };
    while ((lasts(least) || (publisher_.isSending() && lasts(most))) && interruption() == before)
      callBack(kPollInterval);
  };
  if (interruption() == 0) wait(kLastMessages, kLongestSending);
  publisher_.clear();
  wait(0.2 * kLastMessages, kLastMessages);
}

bool Node::isDue() const {
  if (run_.isOver() || rests()) return false;
  return paused_ || ros::SteadyTime::now() >= pacer_.dueTime(nextTime());
}

void Node::serve() {
  callBack(steps_wanted_ > 0 && driver_.isActing() ? kShortWait : 0.0);
  robots_.lookUp();
  if (isDue()) return;
  const ros::SteadyTime next = run_.isOver() || paused_ ? show_at_ : pacer_.dueTime(nextTime());
  const double wait = (next - ros::SteadyTime::now()).toSec();
  if (wait > 0.0) callBack(std::min(wait, options_.held.empty() ? kLongestService : kShortWait));
}

void Node::callBack(double wait) {
  try {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(wait));
    frames_.receive();
  } catch (const std::exception& error) {  // of interactive_markers, if the clock is beyond 2^31 s
    if (refusals_.isDue()) ROS_ERROR_STREAM("refused: " << error.what());
  }
  if (failure_) std::rethrow_exception(failure_);  // a service told it to its caller only
}

double Node::nextTime() const {
  const bool is_late = paused_ || (pacer_.isLate(run_.nextTime(), ros::SteadyTime::now()) &&
                                   pacer_.dueTime(run_.nextFrameTime()) <= ros::SteadyTime::now());
  const bool is_long = run_.plan().timeOfFrame(1) > kLongFrame * options_.real_time_factor;
  return driver_.isActing() || !is_late || is_long ? run_.nextTime() : run_.nextFrameTime();
}

void Node::advance() {
  const double next = nextTime();
  const bool is_part = next < run_.nextFrameTime();
  change(next, false);
  // Another method may divide the frame otherwise.
  if (is_part && run_.nextTime() != next) change(run_.nextTime(), false);
  if (is_part) run_.advancePart();
  // Inside a frame nobody would call this a divergence.
  if (!is_part || !run_.isFinite()) run_.advance();
  if (steps_wanted_ > 0 && run_.isAtFrame()) --steps_wanted_;
  finishState();
}

void Node::change(double next_time, bool paused) {
  handles_.releaseSilent();
  robots_.follow(options_.real_time_factor, next_time);
  try {
    driver_.apply(run_, next_time, paused);
  } catch (const InputError& error) {
    if (refusals_.isDue()) ROS_ERROR_STREAM("refused: " << error.what());
  }
  if (run_.isChanged()) keepFrame();  // whose state may be another now
}

void Node::goTo(const Scene* to) {
  handles_.reset();
  driver_.reset(run_, to);
  robots_.reset();
  steps_wanted_ = 0;
  logged_ = {};
  run_.advance();
  pacer_ = Pacer(options_.real_time_factor, options_.display_rate);
  pacer_.start(run_.time(), ros::SteadyTime::now());
  finishState();
}

void Node::keepFrame() {
  if (!run_.isAtFrame() || !run_.isShown() || !run_.isFinite()) return;
  last_frame_ = run_.state();
  last_frame_number_ = run_.frame();
  try {
    files_.write(run_);
  } catch (const FileError&) {
    failure_ = std::current_exception();
    throw;
  }
}

void Node::finishState() {
  if (run_.wasStopped()) return;  // inside a frame, which is discarded
  const ros::SteadyTime now = ros::SteadyTime::now();
  pacer_.reached(run_.time(), now);
  keepFrame();
  show();
  show_at_ = now;
}

void Node::show() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  show_at_ = now + ros::WallDuration(kShowAgainInterval);
  const bool is_left_out =
      !run_.isAtFrame() && pacer_.isLate(run_.time(), now) && (now - shown_).toSec() < kLongestGap;
  const bool is_due = (pacer_.isShown(run_.time()) && !is_left_out) || rests() || run_.isOver();
  const auto header = publisher_.publish(run_, {rests(), is_due, handles_.isDragging()});
  if (header) shown_ = now;
  if (header && run_.isFinite()) {
    handles_.show();
    robots_.show(*header);
  }
  logChanges();
}

void Node::logStart() const {
  ROS_INFO_STREAM(run_.plan().method.get().name << " on " << fullPath(scenario_.particles) << ", "
                                                << files_.description());
  const Remarks remarks = remarksOn(run_);
  if (!remarks.warning.empty()) ROS_WARN_STREAM(remarks.warning);
  for (const std::string& note : remarks.notes) ROS_INFO_STREAM(note);
}

std::string Node::closingLine() const {
  return run_.closingLine(fmt::format("{}, {}", files_.closingText(), publisher_.numbers()));
}

void Node::logChanges() {
  const Verdict& verdict = run_.verdict();
  const std::string& method = run_.plan().method.get().name;
  if (verdict.kind > logged_.verdict) {
    logged_.verdict = verdict.kind;
    if (verdict.kind == VerdictKind::kDiverged)
      ROS_ERROR_STREAM(method << ": " << outcomeOf(run_, interruption).lines.front()
                              << (run_.isChanged() ? "; call ~reset to start again" : ""));
    else if (verdict.kind != VerdictKind::kNotChecked)
      ROS_WARN_STREAM(method << ": " << verdict.text);
  }
  const std::string remark = run_.toleranceRemark();
  if (remark.size() > logged_.tolerance_remark.size()) ROS_WARN_STREAM(method << ": " << remark);
  logged_.tolerance_remark = remark;
  if (!run_.isOver() || logged_.frames != 0) return;
  logged_.frames = run_.shownFrames();
  ROS_INFO_STREAM(closingLine());
  if (options_.at_end == AtEnd::kHold)
    ROS_INFO_STREAM(method << ": the last frame stays shown until Ctrl-C (at_end: hold)");
}

}  // namespace spring_pendulum

#include "ros/node/live_run.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <ros/console.h>

namespace spring_pendulum {
namespace {

/// A subscriber that comes later than this number of inputs misses some.
constexpr std::uint32_t kMostInputs = 20000;
/// Largest memory of the inputs kept for late subscribers, bytes.
constexpr std::size_t kMostBytes = 32'000'000;

/// Unlike ros::Time, it differs for each run, also with use_sim_time.
ros::Time wallTime() {
  const ros::WallTime now = ros::WallTime::now();
  return {now.sec, now.nsec};
}

}  // namespace

LiveRun::LiveRun(ros::NodeHandle& node, ros::NodeHandle& private_node, Run& run,
                 std::unique_ptr<Integrator>& integrator, const NodeOptions& options,
                 Player& player)
    : run_(run),
      integrator_(integrator),
      player_(player),
      inputs_(node.advertise<PendulumInput>("inputs", kMostInputs,
                                            [this](const ros::SingleSubscriberPublisher& late) {
                                              for (const PendulumInput& input : sent_)
                                                late.publish(input);
                                            })),
      log_(options.displayInterval(), wallTime(),
           [this, frame = options.frame_id](PendulumInput message) {
             message.header.stamp = ros::Time::now();
             message.header.frame_id = frame;
             inputs_.publish(message);
             sent_bytes_ += ros::serialization::serializationLength(message);
             if (sent_.size() < kMostInputs && sent_bytes_ < kMostBytes)
               sent_.push_back(std::move(message));
           }),
      holders_(run, &log_),
      frames_(options.frame_id),
      handles_(node, run, options, holders_, frames_, menuActions()),
      held_inputs_(node, run, options, holders_, frames_),
      commands_(
          private_node, run, options, holders_, frames_,
          [this](double factor) { player_.setSpeed(factor); }, [this] { player_.touch(); }),
      states_(private_node, run,
              [this](Particles particles) { player_.goTo(std::move(particles)); }) {}

MenuActions LiveRun::menuActions() {
  return {[this] { player_.pause(!player_.isPaused()); },
          [this] {
            player_.pause(true);
            player_.step();
          },
          [this] { player_.reset(); }, [this] { ROS_INFO_STREAM(states_.save()); },
          [this] { player_.touch(); }};
}

void LiveRun::start() {
  run_.advance(*integrator_);
  log_.started(run_, run_.time());
  states_.remember();
}

void LiveRun::change(double next_time, bool paused) {
  handles_.watch();
  held_inputs_.watch();
  try {
    holders_.apply(run_, integrator_, next_time, paused);
  } catch (const InputError& error) {
    if (refusals_.isDue()) ROS_ERROR_STREAM("refused: " << error.what());
  }
}

void LiveRun::act(Player::Action action, const Publisher& publisher) {
  if (action == Player::Action::kReset) {
    handles_.reset();
    const auto wanted = player_.takeWanted();
    holders_.reset(run_, integrator_, wanted ? &*wanted : nullptr);
    held_inputs_.reset();
    run_.advance(*integrator_);
  } else if (action == Player::Action::kShowAgain) {
    if (player_.isPaused()) change(run_.nextTime(), true);
  } else if (action == Player::Action::kAdvance && publisher.isWatched()) {
    change(run_.nextTime(), false);
    run_.advancePart(*integrator_);
    // Inside a frame nobody would call this a divergence.
    if (!run_.isFinite()) run_.advance(*integrator_);
  } else {
    change(run_.nextFrameTime(), false);
    run_.advance(*integrator_);
  }
  states_.remember();
}

void LiveRun::show(const std_msgs::Header& header) {
  if (!run_.isFinite()) return;
  handles_.show();
  held_inputs_.show(header);
}

}  // namespace spring_pendulum

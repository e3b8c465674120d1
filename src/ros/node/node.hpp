// The node: one loop that owns a run, shows its states in time, and acts on requests between them.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/handles.hpp"
#include "ros/inputs/robots.hpp"
#include "ros/inputs/services.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/node/pacer.hpp"
#include "ros/node/publisher.hpp"
#include "ros/node/run_log.hpp"
#include "ros/parameters/parameters.hpp"
#include <spring_pendulum/PendulumState.h>
#include <spring_pendulum/io/run_files.hpp>

#include <memory>
#include <string>
#include <vector>

namespace spring_pendulum {

class Node {
 public:
  /// Removes the frames of earlier runs.
  /// \throws InputError, FileError before that for a run that is impossible
  Node(ros::NodeHandle& node, ros::NodeHandle& private_node, const NodeConfiguration& configuration,
       const Scene& scene);

  /// Runs until the end of the run, of ROS, or a signal.
  void spin();
  const Run& run() const { return run_; }

 private:
  /// Acts on a request, see RequestHandler.
  std::string take(const Request& request);
  std::string on(const Pause& request);
  std::string on(const Step& request);
  std::string on(const Reset& request);
  std::string on(const SaveState& request);
  std::string on(const LoadState& request);
  std::string on(const SetConstant& request);
  template <typename Other>
  std::string on(const Other& request) {
    return driver_.on(request);
  }
  void onLeaderState(const PendulumState::ConstPtr& state);
  void record(PendulumInput input);

  bool isDue() const;
  bool isLoopDue() const;
  bool isAtExit() const;
  void serve();
  void advance();
  void change(double next_time, bool paused);
  void goTo(const Scene* to);
  void finishState();
  void show();
  void end();
  Showing showing();
  std::string overMessage() const;

  NodeOptions options_;
  Scenario scenario_;
  Run run_;
  Publisher publisher_;
  Pacer pacer_;
  std::vector<PendulumInput> sent_;  ///< inputs, for subscribers that come late
  std::size_t sent_bytes_ = 0;
  Stamps input_stamps_{false};
  ros::Publisher inputs_;
  InputLog input_log_;
  Driver driver_;
  Frames frames_;
  Handles handles_;
  Robots robots_;
  std::vector<ros::ServiceServer> services_;
  ros::Subscriber leader_;
  RunFiles files_;
  RunLog log_;
  std::string values_;  ///< parameters in effect

  bool ended_ = false;
  bool paused_ = false;
  std::int64_t steps_wanted_ = 0;
  double leader_time_ = -1.0;  ///< s, simulated time of the followed node
  ros::SteadyTime show_at_;    ///< when a run that does not advance is shown again
  ros::SteadyTime over_since_;
  Throttle refusals_;
  State last_frame_;  ///< for SaveState
  std::int64_t last_frame_number_ = 0;
};

}  // namespace spring_pendulum

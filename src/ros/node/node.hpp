// The node: one loop that owns a run, shows its states in time, and acts on requests between them.
#pragma once

#include "ros/inputs/driver.hpp"
#include "ros/inputs/handles.hpp"
#include "ros/inputs/robots.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/node/pacer.hpp"
#include "ros/node/publisher.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/io/run_files.hpp>

#include <exception>
#include <string>
#include <vector>

namespace spring_pendulum {

class Node {
 public:
  /// \param run, files must outlive the node
  Node(Scenario scenario, NodeOptions options, Run& run, RunFiles& files);

  int spin();  ///< runs until the end of the run, or a signal, and returns the exit status

 private:
  /// What was logged since the start or the last reset.
  struct Logged {
    VerdictKind verdict = VerdictKind::kOk;
    std::int64_t frames = 0;  ///< number of frames at the closing line; 0: not logged yet
    std::string tolerance_remark;
  };

  std::vector<ros::ServiceServer> advertiseServices();
  std::string take(const Request& request);  ///< acts on a request, see RequestHandler
  std::string on(const Pause& request);
  std::string on(const Step& request);
  std::string on(const Reset& request);
  std::string on(const SaveState& request);
  std::string on(const LoadState& request);
  template <typename Other>
  std::string on(const Other& request) {
    return driver_.on(request);
  }
  void record(PendulumInput input);

  void waitForSubscribers();
  bool isDue() const;
  /// Simulated time to which the run advances next, s: the next state, or the next frame.
  double nextTime() const;
  bool rests() const { return paused_ && steps_wanted_ == 0; }
  void serve();
  void callBack(double wait);  ///< calls what has come in, or waits this number of seconds for it
  void advance();
  void change(double next_time, bool paused);
  void goTo(const Scene* to);
  void keepFrame();
  void finishState();
  void show();
  void end();

  void logStart() const;
  /// Logs once each: a bad verdict, a divergence with its remedy, the choices of Auto, the end of the run.
  void logChanges();
  std::string closingLine() const;

  static constexpr double kShortWait = 0.002;  ///< s, for tf, or for recorders of inputs
  ros::NodeHandle node_;
  NodeOptions options_;
  Scenario scenario_;
  Run& run_;
  RunFiles& files_;
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

  Logged logged_;
  bool ended_ = false, paused_ = false;
  std::int64_t steps_wanted_ = 0;
  ros::SteadyTime shown_, show_at_;  ///< when a state was published last, and the next is due
  Throttle refusals_;
  State last_frame_;  ///< for SaveState; empty before the run has started
  std::int64_t last_frame_number_ = 0;
  std::exception_ptr failure_;  ///< of writing a frame; ends the node
};

}  // namespace spring_pendulum

// The states at the frames of a run, in memory and in state files, to which the run can go back.
#pragma once

#include <spring_pendulum/Seek.h>
#include <spring_pendulum/StatePath.h>
#include <spring_pendulum/simulation/run.hpp>

#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>

namespace spring_pendulum {

class KeptStates {
 public:
  /// \param run   must outlive this object
  /// \param go_to makes the node go to a frame and the state at it
  KeptStates(ros::NodeHandle& private_node, const Run& run, std::function<void(Particles)> go_to);

  /// Keeps the current state if it is that of a frame. Beyond 32 MB, every other frame is dropped.
  void keep();
  /// Writes the last frame to a state file; see StatePath.srv.
  /// \returns a sentence with the absolute path, or the error
  std::string save();

 private:
  using PathRequest = StatePath::Request;
  using PathResponse = StatePath::Response;
  bool onSave(PathRequest& request, PathResponse& response);
  bool onLoad(PathRequest& request, PathResponse& response);
  bool onSeek(Seek::Request& request, Seek::Response& response);
  void requireStarted() const;
  std::string saveTo(const std::string& file) const;
  void goTo(std::int64_t frame, const State& state);

  const Run& run_;
  std::function<void(Particles)> go_to_;
  std::map<std::int64_t, State> states_;  ///< by frame
  std::int64_t stride_ = 1;               ///< of the kept frames
  State last_;
  std::int64_t last_frame_ = 0;
  std::int64_t reached_ = 0;  ///< the highest frame so far
  double last_time_ = 0.0;    ///< s
  ros::ServiceServer save_, load_, seek_;
};

}  // namespace spring_pendulum

// State files: the services ~save_state and ~load_state.
#pragma once

#include <spring_pendulum/StatePath.h>
#include <spring_pendulum/simulation/run.hpp>

#include <ros/node_handle.h>

#include <cstdint>
#include <functional>
#include <string>

namespace spring_pendulum {

class SavedStates {
 public:
  /// \param run   must outlive this object
  /// \param go_to makes the node go to a frame and the state at it
  SavedStates(ros::NodeHandle& private_node, const Run& run, std::function<void(Particles)> go_to);

  /// Remembers the current state, which ~save_state writes, if it is that of a frame.
  void remember();
  /// Writes the last frame to a state file; see StatePath.srv.
  /// \returns a sentence with the absolute path, or the error
  std::string save();

 private:
  using PathRequest = StatePath::Request;
  using PathResponse = StatePath::Response;
  bool onSave(PathRequest& request, PathResponse& response);
  bool onLoad(PathRequest& request, PathResponse& response);
  void requireStarted() const;

  const Run& run_;
  std::function<void(Particles)> go_to_;
  State last_;
  std::int64_t last_frame_ = 0;
  double last_time_ = 0.0;  ///< s
  ros::ServiceServer save_, load_;
};

}  // namespace spring_pendulum

// The messages about a run, for the topics of a node and for bags.
#pragma once

#include "ros/markers/markers.hpp"
#include "ros/messages/stamps.hpp"
#include "ros/parameters/node_options.hpp"
#include <spring_pendulum/PendulumState.h>
#include <spring_pendulum/PendulumStatus.h>
#include <spring_pendulum/simulation/run.hpp>

#include <optional>
#include <string>
#include <tf2_msgs/TFMessage.h>

namespace spring_pendulum {

/// Sets all fields of the message of a state.
void setState(PendulumState& message, const Run& run, const std_msgs::Header& header);

/// Where the messages of a run go: the topics of a node, or a bag.
class Outlet {
 public:
  virtual ~Outlet() = default;
  /// Called before the messages of a state.
  virtual void start(const std_msgs::Header& header) = 0;
  /// Messages that nobody wants are not built.
  virtual bool wantsMarkers() const { return true; }
  virtual bool wantsState() const { return true; }
  virtual void put(const tf2_msgs::TFMessage& camera) = 0;
  virtual void put(const visualization_msgs::MarkerArray& markers) = 0;
  virtual void put(const PendulumState& state) = 0;
  virtual void put(const PendulumStatus& status) = 0;
};

/// How to show a state.
struct Showing {
  bool paused = false;    ///< whether the user has paused the run
  std::string pace = {};  ///< speed of the run, for the text
  bool due = true;        ///< false: send nothing but a changed status
};

class RunMessages {
 public:
  /// \param simulated stamp with simulated time instead of ROS time
  /// \throws InputError if the run ends after the last simulated stamp
  RunMessages(const Run& run, const NodeOptions& options, bool simulated);

  /// Returns the header of the next messages, with a new stamp.
  std_msgs::Header header(double simulated_time);
  void freezeCamera(bool freeze) { markers_.freezeCamera(freeze); }

  /// Sends the state in all messages that are wanted, with the same header, and the status and the
  /// camera if they have changed.
  /// \returns the header; nothing if nothing was sent
  std::optional<std_msgs::Header> send(const Run& run, const Showing& showing, Outlet& outlet);

 private:
  std::string frame_id_;
  Stamps stamps_;
  Markers markers_;
  PendulumState state_;  ///< kept, so that its arrays are allocated once
  std::string last_status_;
};

}  // namespace spring_pendulum

// Inputs in other tf frames: brings them into the frame of the chain.
#pragma once

#include "ros/messages/stamps.hpp"

#include <ros/callback_queue.h>
#include <ros/subscriber.h>

#include <deque>
#include <map>
#include <memory>
#include <string>
#include <tf2/LinearMath/Transform.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>
#include <utility>

namespace spring_pendulum {

/// A transform into the frame of the chain.
struct StampedTransform {
  tf2::Transform transform = tf2::Transform::getIdentity();
  double stamp = 0.0;  ///< s; 0: it does not change
};

/// Listens to tf from the first frame on that is not the frame of the chain. Unlike
/// tf2_ros::TransformListener, it needs no thread, where an exception of tf2 would end the program.
class Frames {
 public:
  /// \param frame_id frame of the chain
  explicit Frames(std::string frame_id) : frame_id_(std::move(frame_id)) {}
  void listen();
  /// Returns the latest transform from a frame; an empty name means the frame of the chain, and a
  /// leading '/' does not count. Waits until half a second after the first call of `listen`.
  /// \throws InputError if there is no transform
  StampedTransform from(const std::string& name);
  /// Takes what has come in, or waits this number of seconds for it. Must be called often.
  void receive(double wait = 0.0) { queue_.callAvailable(ros::WallDuration(wait)); }

 private:
  /// From a frame to its parent.
  struct Edge {
    std::deque<geometry_msgs::TransformStamped> kept;  ///< by one clock, oldest first
    double latest = 0.0;                               ///< stamp, s; 0: none
    int old_ones = 0;                                  ///< how many have come since that are older
    bool is_fixed = false, is_outdated = false;        ///< outdated: tf2 would refuse the last ones
  };

  void take(const tf2_msgs::TFMessage& message, bool is_static);
  void note(const geometry_msgs::TransformStamped& transform, bool is_static);
  /// Gives a new tf2 the transforms kept if one on the way from a frame is outdated.
  void renew(const std::string& frame);

  std::string frame_id_;
  std::unique_ptr<tf2::BufferCore> transforms_ = std::make_unique<tf2::BufferCore>();
  ros::CallbackQueue queue_;  ///< served by `receive`
  ros::Subscriber moving_, fixed_;
  ros::SteadyTime waits_until_;        ///< for the first transforms
  std::map<std::string, Edge> edges_;  ///< by child
  Throttle warnings_;
  std::map<std::string, Throttle> renewals_;  ///< by outdated child
};

}  // namespace spring_pendulum

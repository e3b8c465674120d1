#include "ros/inputs/services.hpp"

#include <spring_pendulum/Set.h>
#include <spring_pendulum/StatePath.h>

#include <boost/function.hpp>

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <exception>
#include <utility>

namespace spring_pendulum {

template <typename Service, typename MakeRequest>
void Services::advertise(ros::NodeHandle& node, const char* name, MakeRequest make_request) {
  using Call = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Call&, Response&)> serve = [this, make_request](Call& call,
                                                                             Response& response) {
    try {
      response.message = take_(make_request(call));
      response.success = 1;
    } catch (const std::exception& error) {
      response.message = error.what();
      response.success = 0;
    }
    return true;
  };
  servers_.push_back(node.advertiseService(name, serve));
}

Services::Services(ros::NodeHandle& private_node, Frames& frames, RequestHandler take)
    : frames_(frames), take_(std::move(take)) {
  using std_srvs::SetBool;
  using std_srvs::Trigger;
  ros::NodeHandle& node = private_node;
  advertise<SetBool>(node, "pause", [](auto& call) { return Pause{call.data != 0}; });
  advertise<Trigger>(node, "step", [](auto&) { return Step{}; });
  advertise<Trigger>(node, "reset", [](auto&) { return Reset{}; });
  advertise<Set>(node, "set", [](auto& call) { return SetConstant{call.name, call.value}; });
  advertise<ApplyForce>(node, "apply_force", [this](auto& call) { return forceRequest(call); });
  advertise<Trigger>(node, "clear_forces", [](auto&) { return ClearForces{}; });
  advertise<Trigger>(node, "at_rest", [](auto&) { return ComeToRest{}; });
  advertise<StatePath>(node, "save_state", [](auto& call) { return SaveState{call.file}; });
  advertise<StatePath>(node, "load_state", [](auto& call) { return LoadState{call.file}; });
}

Request Services::forceRequest(const ApplyForce::Request& call) {
  const geometry_msgs::Vector3 force = rotated(frames_.from(call.frame_id).transform.rotation,
                                               call.force.x, call.force.y, call.force.z);
  return ApplyForceTo{call.particle - 1, {force.x, force.z}, call.start_time, call.duration};
}

}  // namespace spring_pendulum

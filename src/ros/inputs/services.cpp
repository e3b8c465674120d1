#include "ros/inputs/services.hpp"

#include "base/numbers.hpp"
#include <spring_pendulum/ApplyForce.h>
#include <spring_pendulum/Set.h>
#include <spring_pendulum/SetMethod.h>
#include <spring_pendulum/StatePath.h>

#include <boost/function.hpp>

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <exception>

namespace spring_pendulum {
namespace {

/// Returns a service whose calls `make_request` turns into requests.
template <typename Service, typename MakeRequest>
ros::ServiceServer service(ros::NodeHandle& node, const char* name, const RequestHandler& take,
                           MakeRequest make_request) {
  using Call = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Call&, Response&)> serve = [take, make_request](Call& call,
                                                                             Response& response) {
    try {
      response.message = take(make_request(call));
      response.success = 1;
    } catch (const std::exception& error) {
      response.message = error.what();
      response.success = 0;
    }
    return true;
  };
  return node.advertiseService(name, serve);
}

}  // namespace

std::vector<ros::ServiceServer> advertiseServices(ros::NodeHandle& private_node, Frames& frames,
                                                  const RequestHandler& take) {
  using std_srvs::SetBool;
  using std_srvs::Trigger;
  ros::NodeHandle& node = private_node;
  const auto force = [&frames](ApplyForce::Request& call) {
    const tf2::Vector3 turned = frames.from(call.frame_id).transform.getBasis() *
                                tf2::Vector3(call.force.x, call.force.y, call.force.z);
    return ApplyForceTo{
        call.particle - 1, {turned.x(), turned.z()}, call.start_time, call.duration};
  };
  return {
      service<SetBool>(node, "pause", take, [](auto& call) { return Pause{call.data != 0}; }),
      service<Trigger>(node, "step", take, [](auto&) { return Step{}; }),
      service<Trigger>(node, "reset", take, [](auto&) { return Reset{}; }),
      service<Set>(node, "set", take,
                   [](auto& call) {
                     return SetConstant{call.name, numberText(call.value)};
                   }),
      service<SetMethod>(node, "set_method", take,
                         [](auto& call) {
                           return SetConstant{"method", call.method};
                         }),
      service<ApplyForce>(node, "apply_force", take, force),
      service<Trigger>(node, "clear_forces", take, [](auto&) { return ClearForces{}; }),
      service<Trigger>(node, "at_rest", take, [](auto&) { return ComeToRest{}; }),
      service<StatePath>(node, "save_state", take, [](auto& call) { return SaveState{call.file}; }),
      service<StatePath>(node, "load_state", take, [](auto& call) { return LoadState{call.file}; }),
  };
}

}  // namespace spring_pendulum

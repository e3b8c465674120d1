// What is asked of a node: its services, and what it does itself on a request.
#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "io/files/touched_files.hpp"
#include "io/formats/state_file.hpp"
#include "ros/node/node.hpp"
#include "simulation/judge.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/ApplyForce.h>
#include <spring_pendulum/Set.h>
#include <spring_pendulum/SetMethod.h>
#include <spring_pendulum/StatePath.h>
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <boost/function.hpp>
#include <fmt/format.h>

#include <ros/console.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <algorithm>
#include <exception>

namespace spring_pendulum {
namespace {

constexpr const char* kDefaultStateFile = "pendulum_state.txt";

std::string overMessage(const Run& run) {
  if (run.wasStopped()) return "the node is ending";
  return fmt::format("the run ended at frame {}{}; call ~reset to start it again", run.frame(),
                     run.isShown() ? "" : ", because the motion diverged");
}

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

std::vector<ros::ServiceServer> Node::advertiseServices() {
  using std_srvs::SetBool;
  using std_srvs::Trigger;
  ros::NodeHandle node("~");
  const RequestHandler take = [this](const Request& request) { return this->take(request); };
  const auto method = [](auto& call) { return SetConstant{"method", call.method}; };
  const auto constant = [](Set::Request& call) {
    if (call.name == "method") throw InputError("method: give its name to ~set_method");
    return SetConstant{call.name, numberText(call.value)};
  };
  const auto force = [this](ApplyForce::Request& call) {
    const tf2::Vector3 turned = frames_.from(call.frame_id).transform.getBasis() *
                                tf2::Vector3(call.force.x, call.force.y, call.force.z);
    return ApplyForceTo{
        call.particle - 1, {turned.x(), turned.z()}, call.start_time, call.duration};
  };
  return {
      service<SetBool>(node, "pause", take, [](auto& call) { return Pause{call.data != 0}; }),
      service<Trigger>(node, "step", take, [](auto&) { return Step{}; }),
      service<Trigger>(node, "reset", take, [](auto&) { return Reset{}; }),
      service<Set>(node, "set", take, constant),
      service<SetMethod>(node, "set_method", take, method),
      service<ApplyForce>(node, "apply_force", take, force),
      service<Trigger>(node, "clear_forces", take, [](auto&) { return ClearForces{}; }),
      service<Trigger>(node, "at_rest", take, [](auto&) { return ComeToRest{}; }),
      service<StatePath>(node, "save_state", take, [](auto& call) { return SaveState{call.file}; }),
      service<StatePath>(node, "load_state", take, [](auto& call) { return LoadState{call.file}; }),
  };
}

std::string Node::take(const Request& request) {
  if (ended_) throw InputError("the node is ending");
  if (last_frame_.size() == 0) throw InputError("the run has not started yet");
  if (rests()) change(run_.time(), true);  // a request is about what the holders do now
  std::string sentence = std::visit([this](const auto& each) { return on(each); }, request);
  show_at_ = ros::SteadyTime::now();
  return sentence;
}

std::string Node::on(const Pause& request) {
  const bool paused = request.paused, is_new = paused != paused_;
  // Only whole frames can be saved. The loop finishes a long one, as it serves inputs meanwhile.
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(0.5);
  while (paused && is_new && !run_.isAtFrame() && !run_.isOver() && ros::SteadyTime::now() < end) {
    advance();
    if (driver_.isActing()) ros::WallDuration(kShortWait).sleep();
  }
  if (run_.isOver()) throw InputError(overMessage(run_));
  const std::int64_t missing = !is_new ? steps_wanted_ : paused && !run_.isAtFrame() ? 1 : 0;
  const std::int64_t frame = run_.frame() + missing;
  const char* const now = !paused ? "running" : missing > 0 ? "pausing" : "paused";
  std::string sentence = fmt::format("{}{} at frame {}, t = {:.6g} s", is_new ? "" : "already ",
                                     now, frame, run_.plan().timeOfFrame(frame));
  if (!is_new) return sentence;
  steps_wanted_ = missing;
  paused_ = paused;
  pacer_.start(run_.time(), ros::SteadyTime::now());
  return sentence;
}

std::string Node::on(const Step& /*request*/) {
  if (run_.isOver()) throw InputError(overMessage(run_));
  if (!paused_) throw InputError("the run is not paused; call ~pause first");
  steps_wanted_ = std::min(steps_wanted_ + 1, run_.plan().frames - 1 - run_.frame());
  return fmt::format("advancing to frame {}", run_.frame() + steps_wanted_);
}

std::string Node::on(const Reset& /*request*/) {
  const std::int64_t from = run_.frame();
  goTo(nullptr);
  return fmt::format("back to frame {} from frame {}", run_.frame(), from);
}

std::string Node::on(const SaveState& request) {
  const std::string path = request.file.empty() ? kDefaultStateFile : request.file;
  TouchedFiles touched = touchedFiles(scenario_, "");
  touched.outputs.push_back(path);
  checkTouchedFiles(touched);
  const double time = run_.plan().timeOfFrame(last_frame_number_);
  writeStateFile(path, run_.chain(), last_frame_, last_frame_number_, time);
  std::string sentence =
      fmt::format("frame {}, t = {:.6g} s, is in {}", last_frame_number_, time, fullPath(path));
  ROS_INFO_STREAM(sentence);
  return sentence;
}

std::string Node::on(const LoadState& request) {
  Scenario scenario = scenario_;
  static_cast<Plan&>(scenario) = run_.plan();
  scenario.particles = fullPath(request.file.empty() ? kDefaultStateFile : request.file);
  const Scene loaded = readStateFile(scenario);
  if (loaded.masses.size() != run_.chain().size() || loaded.masses.view() != run_.chain().masses())
    throw InputError(scenario.particles + ": is the state of another chain: the masses differ");
  if (!scenario.method.get().hasFixedStep())
    checkTolerance(scenario.tolerance, run_.chain(), loaded.state);
  static_cast<void>(Judge(run_.chain(), loaded.state, {}));  // refuses an infinite energy
  goTo(&loaded);
  return fmt::format("to frame {} of {}", loaded.frame, scenario.particles);
}

}  // namespace spring_pendulum

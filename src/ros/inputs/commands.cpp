#include "ros/inputs/commands.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "ros/inputs/answer.hpp"
#include "simulation/options/option_set.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/smallest_tolerance.hpp>
#include <spring_pendulum/model/equilibrium.hpp>
#include <spring_pendulum/simulation/reference_run.hpp>

#include <fmt/format.h>

#include <ros/console.h>

#include <cmath>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

const std::vector<std::string> kLive = {"method",   "tolerance",       "stiffness",
                                        "damping",  "rest_length",     "gravity",
                                        "air_drag", "real_time_factor"};

/// Largest constant, in SI units, that a running chain takes over. The motion after larger ones exceeds
/// the range of double, or takes hours per frame.
constexpr double kLargest = 1e9;
/// Largest acceleration by a force, in lengths of the chain per s².
constexpr double kLargestAcceleration = 1e6;

std::string tooLarge(const std::string& name) {
  return fmt::format("{}: must be at most {:g} while the chain moves", name, kLargest);
}

}  // namespace

Commands::Commands(ros::NodeHandle& private_node, const Run& run, const NodeOptions& options,
                   Holders& holders, Frames& frames, std::function<void(double)> set_speed,
                   std::function<void()> show)
    : run_(run),
      options_(options),
      holders_(holders),
      frames_(frames),
      set_speed_(std::move(set_speed)),
      show_(std::move(show)) {
  set_service_ = private_node.advertiseService("set", &Commands::onSet, this);
  force_ = private_node.advertiseService("apply_force", &Commands::onApplyForce, this);
  clear_ = private_node.advertiseService("clear_forces", &Commands::onClearForces, this);
  at_rest_ = private_node.advertiseService("at_rest", &Commands::onAtRest, this);
}

std::string Commands::set(const std::string& name, const std::string& value) {
  if (std::find(kLive.begin(), kLive.end(), name) == kLive.end()) {
    throw InputError(unknownName("live constant", name, kLive));
  }
  if (name == "real_time_factor") {
    NodeOptions options = options_;
    OptionSet all(playOptions(options));
    all.set(all.find(name, "set"), value, name);
    if (options.real_time_factor > kLargest) throw InputError(tooLarge(name));
    options_.real_time_factor = options.real_time_factor;
    set_speed_(options.real_time_factor);
    return fmt::format("real_time_factor is {}", numberText(options.real_time_factor));
  }
  Scenario wanted = holders_.wanted();
  OptionSet all(scenarioOptions(wanted));
  const Option& option = all.find(name, "set");
  all.set(option, value, name);
  checkScenario(wanted);
  const double largest = std::max({wanted.stiffness, wanted.damping, wanted.rest_length,
                                   std::abs(wanted.gravity), wanted.air_drag});
  if (largest > kLargest) throw InputError(tooLarge(name));
  if (!wanted.method.get().hasFixedStep()) {
    checkTolerance(wanted.tolerance, wanted.chainOf(run_.chain().masses()),
                   run_.isOver() ? run_.start() : run_.state());
  }
  holders_.wanted() = wanted;
  return fmt::format("{} is {} from the next state on", name, option.text());
}

bool Commands::onSet(Set::Request& request, Set::Response& response) {
  return answer(response, [&] { return set(request.name, request.value); });
}

std::string Commands::applyForce(const ApplyForce::Request& request) {
  if (request.particle < 1 || request.particle > run_.chain().size()) {
    throw InputError(fmt::format("particle {} does not exist: the chain has particles 1 to {}",
                                 request.particle, run_.chain().size()));
  }
  const std::ptrdiff_t particle = request.particle - 1;
  if (particle == 0 || holders_.isHeld(particle)) {
    throw InputError(
        fmt::format("particle {} is held: a force would not move it", request.particle));
  }
  const auto& f = request.force;
  if (!std::isfinite(request.start_time) || !std::isfinite(request.duration)) {
    throw InputError("start_time and duration must be finite");
  }
  const geometry_msgs::Vector3 force =
      rotated(frames_.from(request.frame_id).transform.rotation, f.x, f.y, f.z);
  const double strongest = kLargestAcceleration * run_.chain().masses()[particle] *
                           std::max(chainLength(run_.chain(), run_.start()), 1.0);
  if (!(std::hypot(f.x, f.y, f.z) <= strongest)) {
    throw InputError(
        fmt::format("force must be at most {:.3g} N on particle {}", strongest, request.particle));
  }
  const double begin = std::max(request.start_time, run_.time());
  const double end =
      request.duration < 0.0 ? std::numeric_limits<double>::infinity() : begin + request.duration;
  if (!holders_.push({particle, {force.x, force.z}, begin, end})) {
    throw InputError("too many forces act already; call ~clear_forces");
  }
  return fmt::format("particle {}: ({:.6g}, {:.6g}) N from t = {:.6g} s {}", request.particle,
                     force.x, force.z, begin,
                     std::isinf(end) ? "until clear_forces" : fmt::format("to {:.6g} s", end));
}

bool Commands::onApplyForce(ApplyForce::Request& request, ApplyForce::Response& response) {
  return answer(response, [&] { return applyForce(request); });
}

bool Commands::onClearForces(std_srvs::Trigger::Request& /*request*/,
                             std_srvs::Trigger::Response& response) {
  return answer(response, [&] {
    return counted(static_cast<std::int64_t>(holders_.clearForces()), "force") + " cleared";
  });
}

bool Commands::onAtRest(std_srvs::Trigger::Request& /*request*/,
                        std_srvs::Trigger::Response& response) {
  return answer(response, [&] {
    if (run_.isOver()) throw InputError("the run is over; call ~reset to start it again");
    const Chain wanted = holders_.wanted().chainOf(run_.chain().masses());
    holders_.jumpTo(equilibrium(wanted.drivenBy(run_.chain().drive()), run_.state()));
    show_();
    return std::string("the chain hangs at rest from the next state on");
  });
}

}  // namespace spring_pendulum

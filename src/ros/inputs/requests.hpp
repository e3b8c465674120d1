// What is asked of a node from outside: by services, the mouse in rviz and robots. Between two states only,
// the callback queue of ROS is served: a callback hands a request to the node, which acts on it and answers.
#pragma once

#include <spring_pendulum/model/chain.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <variant>

namespace spring_pendulum {

/// Where a held particle shall be.
struct Target {
  PlaneVector<double> position{};      ///< m
  PlaneVector<double> velocity{};      ///< m/s
  PlaneVector<double> acceleration{};  ///< m/s²
  double fastest = 0.0;  ///< m/s, of the particle relative to it; 0: as the driver has it
};

struct Pause {
  bool paused = true;
};
struct Step {};
struct Reset {};
struct SaveState {
  std::string file;
};
struct LoadState {
  std::string file;
};
struct SetConstant {
  std::string name;
  std::string value;
};
struct ApplyForceTo {
  std::ptrdiff_t particle = 0;  ///< counted from 0, as in all requests
  PlaneVector<double> force{};  ///< N
  double start_time = 0.0;      ///< s of simulated time; in the past: now
  double duration = 0.0;        ///< s of simulated time; negative: until ClearForces
};
struct ClearForces {};
struct ComeToRest {};
struct Hold {
  std::ptrdiff_t particle = 0;
  std::optional<Target> target;  ///< nothing: where it is
};
struct Release {
  std::ptrdiff_t particle = 0;
};

using Request = std::variant<Pause, Step, Reset, SaveState, LoadState, SetConstant, ApplyForceTo,
                             ClearForces, ComeToRest, Hold, Release>;

/// Acts on a request.
/// \returns a sentence that says what happened
/// \throws InputError for a request that is refused
using RequestHandler = std::function<std::string(const Request&)>;

}  // namespace spring_pendulum

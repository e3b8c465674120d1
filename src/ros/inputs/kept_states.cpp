#include "ros/inputs/kept_states.hpp"

#include "io/files/paths.hpp"
#include "io/formats/run_files.hpp"
#include "io/formats/state_file.hpp"
#include "ros/inputs/answer.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr std::size_t kMostBytes = 32'000'000;  ///< of all kept states
constexpr std::size_t kBytesBeside = 112;       ///< of a kept state, beside its numbers
constexpr const char* kDefaultFile = "pendulum_state.txt";

}  // namespace

KeptStates::KeptStates(ros::NodeHandle& private_node, const Run& run,
                       std::function<void(Particles)> go_to)
    : run_(run), go_to_(std::move(go_to)) {
  save_ = private_node.advertiseService("save_state", &KeptStates::onSave, this);
  load_ = private_node.advertiseService("load_state", &KeptStates::onLoad, this);
  seek_ = private_node.advertiseService("seek", &KeptStates::onSeek, this);
}

void KeptStates::keep() {
  if (!run_.isAtFrame() || !run_.isShown() || !run_.isFinite()) return;
  last_ = run_.state();
  last_frame_ = run_.frame();
  last_time_ = run_.time();
  reached_ = std::max(reached_, last_frame_);
  if (last_frame_ % stride_ != 0) return;
  states_[last_frame_] = last_;
  const std::size_t bytes = 4 * sizeof(double) * static_cast<std::size_t>(last_.size());
  if (states_.size() * (bytes + kBytesBeside) <= kMostBytes) return;
  stride_ *= 2;
  for (auto it = states_.begin(); it != states_.end();) {
    it = it->first % stride_ == 0 ? std::next(it) : states_.erase(it);
  }
}

void KeptStates::requireStarted() const {
  if (states_.empty()) throw InputError("the run has not started yet");
}

std::string KeptStates::saveTo(const std::string& file) const {
  requireStarted();
  const std::string path = file.empty() ? kDefaultFile : file;
  TouchedFiles touched = touchedFiles(run_.scenario(), "");
  touched.outputs.push_back(path);
  checkTouchedFiles(touched);
  writeStateFile(path, run_.chain(), last_, last_frame_, last_time_);
  return fmt::format("frame {}, t = {:.6g} s, is in {}", last_frame_, last_time_, fullPath(path));
}

std::string KeptStates::save() {
  PathRequest request;
  PathResponse response;
  onSave(request, response);
  return response.message;
}

bool KeptStates::onSave(PathRequest& request, PathResponse& response) {
  return answer(response, [&] { return saveTo(request.file); });
}

bool KeptStates::onLoad(PathRequest& request, PathResponse& response) {
  return answer(response, [&] {
    requireStarted();
    Scenario scenario = run_.scenario();
    const std::string& given = scenario.save_state;
    scenario.particles = !request.file.empty() ? request.file
                         : !given.empty()      ? given
                                               : kDefaultFile;
    Particles loaded = readStateFile(scenario);
    if (loaded.masses.size() != run_.chain().size() ||
        loaded.masses.view() != run_.chain().masses()) {
      throw InputError(
          fmt::format("{}: is the state of another chain: the masses differ", scenario.particles));
    }
    goTo(loaded.frame, loaded.state);
    return fmt::format("to frame {} of {}", loaded.frame, fullPath(scenario.particles));
  });
}

bool KeptStates::onSeek(Seek::Request& request, Seek::Response& response) {
  return answer(response, [&] {
    requireStarted();
    const auto after = states_.upper_bound(request.frame);
    if (request.frame > reached_ || after == states_.begin()) {
      throw InputError(fmt::format("frame {}: must be {} to {}, the frames until now",
                                   request.frame, states_.begin()->first, reached_));
    }
    const auto& [frame, state] = *std::prev(after);
    goTo(frame, state);
    return fmt::format("to frame {}{}", frame,
                       frame == request.frame ? "" : ", the last one before that was kept");
  });
}

void KeptStates::goTo(std::int64_t frame, const State& state) {
  checkFirstFrame(run_.scenario(), frame);
  go_to_({run_.chain().masses(), state, frame});
}

}  // namespace spring_pendulum

#include "ros/inputs/saved_states.hpp"

#include "io/files/paths.hpp"
#include "io/formats/run_files.hpp"
#include "io/formats/state_file.hpp"
#include "ros/inputs/answer.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <utility>

namespace spring_pendulum {
namespace {

constexpr const char* kDefaultFile = "pendulum_state.txt";

}  // namespace

SavedStates::SavedStates(ros::NodeHandle& private_node, const Run& run,
                         std::function<void(Particles)> go_to)
    : run_(run), go_to_(std::move(go_to)) {
  save_ = private_node.advertiseService("save_state", &SavedStates::onSave, this);
  load_ = private_node.advertiseService("load_state", &SavedStates::onLoad, this);
}

void SavedStates::remember() {
  if (!run_.isAtFrame() || !run_.isShown() || !run_.isFinite()) return;
  last_ = run_.state();
  last_frame_ = run_.frame();
  last_time_ = run_.time();
}

void SavedStates::requireStarted() const {
  if (last_.size() == 0) throw InputError("the run has not started yet");
}

std::string SavedStates::save() {
  PathRequest request;
  PathResponse response;
  onSave(request, response);
  return response.message;
}

bool SavedStates::onSave(PathRequest& request, PathResponse& response) {
  return answer(response, [&] {
    requireStarted();
    const std::string path = request.file.empty() ? kDefaultFile : request.file;
    TouchedFiles touched = touchedFiles(run_.scenario(), "");
    touched.outputs.push_back(path);
    checkTouchedFiles(touched);
    writeStateFile(path, run_.chain(), last_, last_frame_, last_time_);
    return fmt::format("frame {}, t = {:.6g} s, is in {}", last_frame_, last_time_, fullPath(path));
  });
}

bool SavedStates::onLoad(PathRequest& request, PathResponse& response) {
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
    checkFirstFrame(scenario, loaded.frame);
    const std::int64_t frame = loaded.frame;
    go_to_(std::move(loaded));
    return fmt::format("to frame {} of {}", frame, fullPath(scenario.particles));
  });
}

}  // namespace spring_pendulum

// MuJoCo with its Runge-Kutta integrator: two slide joints per particle, and per spring a spatial
// tendon with stiffness, damping and springlength, which is exactly this model.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cstring>

#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

[[noreturn]] void throwMessage(const char* message) {
  throw PeerError(message);
}
void dropWarning(const char* /*message*/) {}

std::string modelText(const Problem& problem, double time_step) {
  const std::size_t n = problem.size();
  const double* x = problem.start.data();
  const double* y = x + n;
  std::string text = fmt::format(
      "<mujoco><compiler autolimits='false'/><size nconmax='0' njmax='0'/>"
      "<option integrator='RK4' jacobian='sparse' timestep='{}' gravity='0 {} 0'>"
      "<flag contact='disable' constraint='disable'/></option><worldbody>"
      "<site name='s0' pos='{} {} 0'/>",
      time_step, -problem.gravity, x[0], y[0]);
  for (std::size_t i = 1; i < n; ++i) {
    text += fmt::format(
        "<body pos='{0} {1} 0'><joint type='slide' axis='1 0 0'/><joint type='slide' axis='0 1 0'/>"
        "<inertial pos='0 0 0' mass='{2}' diaginertia='{2} {2} {2}'/><site name='s{3}'/></body>",
        x[i], y[i], problem.masses[i], i);
  }
  text += "</worldbody><tendon>";
  for (std::size_t i = 1; i < n; ++i) {
    text += fmt::format(
        "<spatial stiffness='{}' damping='{}' springlength='{}'><site site='s{}'/><site "
        "site='s{}'/>"
        "</spatial>",
        problem.stiffness, problem.damping, problem.rest_length, i - 1, i);
  }
  return text + "</tendon></mujoco>";
}

mjModel* loadModel(const std::string& text) {
  constexpr const char* kName = "chain.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(text.size())) != 0) {
    throw PeerError("the virtual file system takes no file of this size");
  }
  std::memcpy(files->filedata[0], text.data(), text.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML(kName, files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw PeerError(error);
  return model;
}

class MujocoPeer : public Peer {
 public:
  MujocoPeer(const Problem& problem, const Run& run) : problem_(problem), run_(run) {
    mju_user_error = throwMessage;
    mju_user_warning = dropWarning;
    model_ = loadModel(modelText(problem, run.time_step));
    data_ = mj_makeData(model_);
    if (data_ == nullptr) throw PeerError("mj_makeData failed");
  }
  ~MujocoPeer() override {
    mj_deleteData(data_);
    mj_deleteModel(model_);
  }

  void reset() override { mj_resetData(model_, data_); }

  void advance() override {
    for (std::int64_t n = 0; n < run_.steps; ++n) mj_step(model_, data_);
    steps_ += run_.steps;
    // MuJoCo resets a state that has become too large, with a warning.
    for (const int bad : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
      if (data_->warning[bad].number > 0) throw PeerError("the motion diverged and was reset");
    }
  }

  std::vector<double> state() const override {
    const std::size_t n = problem_.size();
    std::vector<double> z = problem_.start;
    for (std::size_t i = 1; i < n; ++i) {  // joint positions are relative to the start
      for (std::size_t c = 0; c < 2; ++c) {
        z[c * n + i] += data_->qpos[2 * (i - 1) + c];
        z[(2 + c) * n + i] = data_->qvel[2 * (i - 1) + c];
      }
    }
    return z;
  }
  std::int64_t forceEvaluations() const override { return 4 * steps_; }

 private:
  const Problem& problem_;
  Run run_;
  mjModel* model_ = nullptr;
  mjData* data_ = nullptr;
  std::int64_t steps_ = 0;
};

}  // namespace

std::vector<PeerRow> mujocoRows() {
  return {{"MuJoCo", "MuJoCo RK4", Stepping::kFixed, true, makerOf<MujocoPeer>()}};
}

}  // namespace spring_pendulum::benchmark

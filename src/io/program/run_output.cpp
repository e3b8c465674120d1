#include "io/formats/run_files.hpp"
#include "io/formats/state_file.hpp"
#include "io/program/closing.hpp"
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_output.hpp>

namespace spring_pendulum {

Particles readStart(const Scenario& scenario) {
  return scenario.resume ? readStateFile(scenario) : readParticleFile(scenario.particles);
}

struct RunOutput::Files {
  RunFiles files;
};

RunOutput::RunOutput(const Run& run) : files_(new Files{RunFiles(run)}) {}
RunOutput::~RunOutput() = default;
RunOutput::RunOutput(RunOutput&&) noexcept = default;

void RunOutput::write(const Run& run) {
  files_->files.write(run);
}

void RunOutput::finish() {
  files_->files.finish();
}

std::string RunOutput::closingText() const {
  return writingText(files_->files);
}

}  // namespace spring_pendulum

// Runs the cases of a study on all cores, ranks or shards and writes one table.
#include "io/files/touched_files.hpp"
#include "io/program/exit_status.hpp"
#include "io/program/standard_streams.hpp"
#include <spring_pendulum/base/errors.hpp>

#include "sweep/command_line.hpp"
#include "sweep/single_case.hpp"
#include "sweep/sweep_run.hpp"

namespace spring_pendulum::sweep {
namespace {

void checkFiles(const CommandLine& line, const Study& study) {
  TouchedFiles files{{line.study}, {line.options.output}, ""};
  for (const auto& [path, particles] : study.particles) files.inputs.push_back(path);
  if (line.only_case >= 0) {
    files.frame_folder = line.options.output;
    files.outputs = {particlesPath(line.options.output, line.only_case)};
    if (line.options.output.empty()) files.outputs.clear();
  }
  if (line.options.plot) files.outputs.push_back(picturePath(line.options.output));
  checkTouchedFiles(files);
}

int runCommandLine(const CommandLine& line, CaseCounter& counter) {
  if (counter.rank() > 0) {
    if (line.only_case >= 0) return kDone;
    counter.largest(0);  // rank 0 checks everything first, so each error is reported once
  }
  const Study study = readStudy(line.study);
  checkFiles(line, study);
  if (line.only_case >= 0) {
    printCase(study, line.only_case, line.options.output);
    return kDone;
  }
  if (line.options.plot && study.plot.empty()) {
    throw InputError("--plot: the study has no entry plot");
  }
  return runSweep(study, line.options, counter);
}

/// A failure of one rank ends all of them.
int runRank(const CommandLine& line) {
  CaseCounter counter;
  try {
    return runCommandLine(line, counter);
  } catch (const std::exception& error) {
    if (counter.size() == 1) throw;
    const Failure failure = failureOf(error);
    printError(failure.message + "\n");
    counter.abort(failure.status);
    return failure.status;
  }
}

int run(int argc, const char* const* argv) {
  const CommandLine line = parseCommandLine(argc, argv);
  if (line.answer.empty()) return runRank(line);
  printOutput(line.answer);
  return kDone;
}

}  // namespace
}  // namespace spring_pendulum::sweep

int main(int argc, char** argv) {
  return spring_pendulum::runProgram([&] { return spring_pendulum::sweep::run(argc, argv); });
}

// The files that a run reads, writes or removes. None of them may have two uses.
#pragma once

#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <vector>

namespace spring_pendulum {

/// Paths as the user gave them; empty ones are skipped.
struct TouchedFiles {
  std::vector<std::string> inputs;   ///< particle file, configuration
  std::vector<std::string> outputs;  ///< energy file, bag
  std::string frame_folder;          ///< files with the name of a frame are replaced or removed
};

/// Returns the files of a run. Without frame files, the folder is empty.
/// \param config configuration file; empty: none
TouchedFiles touchedFiles(const Scenario& scenario, const std::string& config);

/// Compares outputs and the files to which the standard streams are redirected with each other and with
/// the inputs, by device and inode.
/// \throws InputError if an output is an input, another output, or a frame
/// \throws FileError if an output is also a standard stream
void checkTouchedFiles(const TouchedFiles& files);

}  // namespace spring_pendulum

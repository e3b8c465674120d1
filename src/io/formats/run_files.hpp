// The names of the files of a run.
#pragma once

#include "io/files/touched_files.hpp"
#include <spring_pendulum/io/run_files.hpp>

namespace spring_pendulum {

/// Returns the files of a run.
/// \param config configuration file; empty: none
TouchedFiles touchedFiles(const Scenario& scenario, const std::string& config);

}  // namespace spring_pendulum

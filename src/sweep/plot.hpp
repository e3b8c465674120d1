// Draws the table of a study: runs the script plot_table.py, which lies beside the program.
#pragma once

#include <string>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// \throws FileError if the script, Python or matplotlib is missing
void requirePlotter();

/// Draws a table. The script gets the plot options as arguments: no text of a study is ever a command.
/// \throws FileError if it fails
void drawPlot(const Study& study, const std::string& table, const std::string& picture);

}  // namespace spring_pendulum::sweep

// Draws the table of a study: runs the script plot_table.py, which lies beside the program.
#pragma once

#include <string>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// Draws a table. The script gets the plot entries as arguments: no text of a study is ever a command.
/// \param only_try find out whether the table, which may lack columns, can be drawn
/// \returns the exit status of the script, which prints what is wrong
/// \throws FileError if there is no Python
int drawPlot(const Study& study, const std::string& table, const std::string& picture,
             bool only_try);

}  // namespace spring_pendulum::sweep

// Draws the table of a study with gnuplot.
#pragma once

#include <string>
#include <vector>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// Returns the commands that draw a table.
/// \param rows without the header
/// \param path of the pictures, without extension
std::string plotScript(const Study& study, const std::vector<std::string>& rows,
                       const std::string& path);

/// Draws PATH.png and PATH.svg.
/// \throws FileError if gnuplot can't be run or fails
void drawPlot(const Study& study, const std::vector<std::string>& rows, const std::string& path);

}  // namespace spring_pendulum::sweep

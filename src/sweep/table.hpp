// The table of a study: its columns, its rows and its picture.
#pragma once

#include "sweep/study/study.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum::sweep {

struct Column {
  std::string_view name;
  std::string_view unit;  ///< empty: none
  std::string_view meaning;
  double (*value)(const Run&);  ///< null: the verdict
  bool at_frames = false;    ///< whether it is the largest value at the frames, not that at the end
  bool if_diverged = false;  ///< whether it says something about a diverged run; else NaN
};

const std::vector<Column>& allColumns();

/// \throws InputError that lists the known columns
const Column& findColumn(std::string_view name, std::string_view place);

/// The header of the table.
std::string tableHeader(const Study& study);
/// The beginning of a row: number and values of the case.
std::string rowStart(const Study& study, std::int64_t index);

/// Runs a case.
/// \returns the columns as comma-separated text; nothing if `stop` has stopped the run
std::optional<std::string> runCase(const Study& study, const Case& a_case,
                                   const std::function<bool()>& stop);

/// Draws a table with plot_table.py, beside the program. No text of a study is ever a command.
/// \param only_try find out whether the table, which may lack columns, can be drawn
/// \returns the exit status of the script, which prints what is wrong
/// \throws FileError if there is no Python
int drawPlot(const Study& study, const std::string& table, const std::string& picture,
             bool only_try);

}  // namespace spring_pendulum::sweep

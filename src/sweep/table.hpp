// The table of a study: its columns and its rows.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

struct Column {
  std::string_view name;
  std::string_view unit;  ///< empty: none
  std::string_view meaning;
  double (*at_frame)(const Run&);  ///< the column is the largest of these; null: given at the end
  std::string (*at_end)(const Run&) = nullptr;
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

}  // namespace spring_pendulum::sweep

// Runs cases and makes their rows.
#pragma once

#include <spring_pendulum/simulation/run.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "sweep/study/columns.hpp"
#include "sweep/study/study.hpp"

namespace spring_pendulum::sweep {

/// The header of the table.
std::string tableHeader(const Study& study);
/// The beginning of a row: number and values of the case.
std::string rowStart(const Study& study, std::int64_t index);

/// Runs a case.
/// \returns the columns as comma-separated text; nothing if `stop` has stopped the run
/// \throws std::runtime_error naming the case
std::optional<std::string> runCase(const WantedColumns& columns, const Case& a_case,
                                   const std::function<bool()>& stop);

}  // namespace spring_pendulum::sweep

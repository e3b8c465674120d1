// Checks that involve several options of a run.
#pragma once

#include "simulation/options/option_set.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// \throws InputError if a number is out of the range of its option, the steps of the run can't be
///   counted in 64 bits, or the run would not end at a finite time
void checkPlan(const Plan& plan);

/// \throws InputError as checkPlan for all options, and if options exclude each other
void checkScenario(const Scenario& scenario);

/// Checks that a run can start at a frame.
/// \throws InputError if it is not one of the frames of the plan
void checkFirstFrame(const Plan& plan, std::int64_t frame);

/// Returns a remark on values that are allowed but hardly meant; empty if there are none.
std::string remarkOn(const Constants& constants);

/// Returns the given options that the method does not use: options for error-controlled methods if
/// the method has a fixed step, and the reverse.
std::vector<std::string_view> unusedKeys(const Plan& plan, const OptionSet& options);

/// Returns why a method does not use such an option, and the options to use instead: "Auto chooses its
/// own steps; use tolerance and frame_interval".
/// \param name how the user writes an option
std::string whyUnused(const Method& method, std::string (*name)(std::string_view key));

}  // namespace spring_pendulum

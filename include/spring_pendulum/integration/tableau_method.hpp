// The row of the method table that follows from a Butcher tableau.
#pragma once

#include <spring_pendulum/integration/method_table.hpp>

#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// Returns the row of an explicit Runge-Kutta method with a fixed step, for `registerMethod`. Its order
/// follows from the order conditions, up to 10, its stability limits from the stability function: up to
/// there, no mode grows by more than 1e-12 per step.
/// \param tableau must outlive the row
/// \throws InputError if the tableau is not one of an explicit method, or the method is not consistent:
///   its weights do not add up to 1
Method methodOfTableau(const std::string& name, const ButcherTableau& tableau);

}  // namespace spring_pendulum
#pragma GCC visibility pop

// The table of methods. The command line, the ROS node, the documents, the stability advice and the
// tests read it. A program can register its own methods.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#pragma GCC visibility push(default)
namespace spring_pendulum {

enum class StepControl { kFixed, kErrorControlled };

struct Method;

/// Constructs an integrator for a chain, which may end before the integrator: copy it.
using IntegratorFactory = std::function<std::unique_ptr<Integrator>(const Method&, const Chain&,
                                                                    const IntegratorOptions&)>;

/// One row of the method table.
struct Method {
  std::string name = {};
  int order = 0;
  int stages = 0;  ///< evaluations of F per step
  StepControl control = StepControl::kFixed;
  /// Largest h|λ| for λ on the negative real axis; infinite: no limit.
  double real_stability_limit = 0.0;
  /// Largest h|λ| for λ on the imaginary axis; 0: unstable at any step.
  double imaginary_stability_limit = 0.0;
  std::string reference = {};
  std::string use = {};                     ///< when to use the method, in one line
  const ButcherTableau* tableau = nullptr;  ///< only of explicit Runge-Kutta methods
  IntegratorFactory make = {};              ///< empty: fixed steps of the tableau
  bool symplectic = false;  ///< undamped, the mean energy is constant, and is judged
  /// Memory per particle of a run in addition to Runge-Kutta-4, bytes; 0: little, or not known.
  double bytes_per_particle = 0.0;

  bool hasFixedStep() const { return control == StepControl::kFixed; }
};

/// All methods, in the order in which they are listed. References to rows stay valid.
const std::deque<Method>& methodTable();

/// Returns the row of an explicit Runge-Kutta method with a fixed step, for `registerMethod`. Its order
/// follows from the order conditions, up to 10, its stability limits from the stability function: up to
/// there, no mode grows by more than 1e-12 per step.
/// \param tableau must outlive the row
/// \throws InputError if the tableau is not one of an explicit method, or the method is not consistent:
///   its weights do not add up to 1
Method methodOfTableau(const std::string& name, const ButcherTableau& tableau);
Method methodOfTableau(const std::string& name, ButcherTableau&& tableau) = delete;

/// Adds a row to the table, so that the method can be used by name. The table copies the row and
/// its tableau. Not thread-safe: register methods before starting other threads.
/// \throws InputError if the name is empty or taken, the tableau is not one of an explicit method
///         with `stages` stages, there is neither tableau nor factory, or a number is out of range
void registerMethod(const Method& method);

/// Returns the method with this name, or else one whose name differs only in case and punctuation.
/// \throws InputError that lists the known names if there is no such method
const Method& findMethod(std::string_view name);

/// Returns the names of all methods: "Euler, Runge-Kutta-2, ...".
std::string knownMethodNames();

/// Makes an integrator.
/// \throws InputError for a chain without particles, an error-controlled method with a tolerance
///         that is not finite and above 0, or a negative number of threads
std::unique_ptr<Integrator> makeIntegrator(const Method& method, const Chain& chain,
                                           const IntegratorOptions& options = {});

/// Makes an integrator of the method with this name.
/// \throws InputError also for an unknown name
std::unique_ptr<Integrator> makeIntegrator(std::string_view method, const Chain& chain,
                                           const IntegratorOptions& options = {});

/// Estimates the smallest position error in m that any method can reach within a few seconds of
/// motion from `start`: a hundred times the rounding error of the largest coordinate, of the
/// distance covered in a second, or of the length of the chain, whichever is largest. Examples:
/// about 2e-13 m for a chain of 10 m; 0.02 m for an anchor at x = 1e12 m.
/// \param start state with the size of the chain
double smallestTolerance(const Chain& chain, const State& start);

/// Checks that the tolerance of an error-controlled method is not below `smallestTolerance`. With a
/// smaller tolerance the step size would shrink until the run makes no progress.
/// \throws InputError naming the smallest possible tolerance
void checkTolerance(double tolerance, const Chain& chain, const State& start);

}  // namespace spring_pendulum
#pragma GCC visibility pop

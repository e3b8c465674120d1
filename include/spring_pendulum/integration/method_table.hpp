// The one place that lists the methods: the command line, the ROS node, the README, the stability
// advice and the tests all read this table.
#pragma once

#include <spring_pendulum/integration/butcher_tableau.hpp>
#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// What a method is told besides the chain.
struct IntegratorOptions {
  double tolerance = 1e-6;         ///< error-controlled methods: position error aimed at, m
  bool track_dissipation = false;  ///< integrate the dissipated power along
  int threads = 0;                 ///< at most; 0: as many as the processor runs at once
};

enum class StepControl { kFixed, kErrorControlled };

/// One method.
struct Method {
  std::string_view name;
  int order;
  int stages;  ///< evaluations of F a step
  StepControl control;
  double real_stability_limit;  ///< largest h|λ| for λ on the negative real axis; inf: no limit
  double imaginary_stability_limit;  ///< largest h|λ| for λ on the imaginary axis; 0: none
  std::string_view reference;
  std::string_view use;           ///< when to take it and when not, in one line
  const ButcherTableau* tableau;  ///< null if it is not an explicit Runge-Kutta method
  std::unique_ptr<Integrator> (*make)(const Method&, const Chain&, const IntegratorOptions&);
  bool symplectic = false;  ///< without damping, the energy oscillates but does not grow
};

/// All methods, in the order in which they are listed to a user.
const std::vector<Method>& methodTable();

/// \throws InputError that lists the known names if there is no such method
const Method& findMethod(std::string_view name);

/// "Euler, Runge-Kutta-2, ..."
std::string knownMethodNames();

/// \throws InputError as findMethod
std::unique_ptr<Integrator> makeIntegrator(std::string_view method, const Chain& chain,
                                           const IntegratorOptions& options = {});

}  // namespace spring_pendulum

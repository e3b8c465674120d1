#include "base/checks.hpp"
#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "integration/automatic/auto_stepper.hpp"
#include "integration/embedded/embedded_runge_kutta_stepper.hpp"
#include "integration/error_control/dense_output_integrator.hpp"
#include "integration/fixed_step/explicit_runge_kutta.hpp"
#include "integration/fixed_step/plain_runge_kutta.hpp"
#include "integration/fixed_step/symplectic.hpp"
#include "integration/implicit/backward_euler.hpp"
#include "integration/implicit/radau_stepper.hpp"
#include "integration/tableau.hpp"
#include "integration/taylor/stabilized_taylor_stepper.hpp"
#include "integration/taylor/taylor_stepper.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

std::unique_ptr<Integrator> makeExplicitRungeKutta(const Method& method, const Chain& chain,
                                                   const IntegratorOptions& options) {
  if (!chain.isPlain() || findAdvanceKernel(fastestChainKernels(), *method.tableau) == nullptr)
    return std::make_unique<PlainRungeKutta>(chain, *method.tableau, options.track_dissipation);
  return std::make_unique<ExplicitRungeKutta>(chain, *method.tableau, options);
}

/// \tparam FixedStepMethod made from a chain
template <typename FixedStepMethod>
std::unique_ptr<Integrator> makeFixedStep(const Method&, const Chain& chain,
                                          const IntegratorOptions& options) {
  return std::make_unique<FixedStepMethod>(chain, options.track_dissipation);
}

/// \tparam Stepper made from a chain, perhaps an order, and a tolerance
template <typename Stepper, int... kOrder>
std::unique_ptr<Integrator> makeErrorControlled(const Method&, const Chain& chain,
                                                const IntegratorOptions& options) {
  return std::make_unique<DenseOutputIntegrator>(
      chain, std::make_unique<Stepper>(chain, kOrder..., options.tolerance),
      options.track_dissipation);
}

// NOLINTNEXTLINE(readability-function-size): data
std::deque<Method> builtInMethods() {
  return {
      {"Euler", 1, 1, StepControl::kFixed, 2.0, 0.0,
       "L. Euler, Institutionum calculi integralis I, 1768, §650",
       "for teaching: undamped oscillations grow at every step size", &kEulerTableau,
       makeExplicitRungeKutta},
      {"Runge-Kutta-2", 2, 2, StepControl::kFixed, 2.0, 0.0,
       "C. Runge, Math. Ann. 46 (1895) 167-178, doi:10.1007/BF01446807",
       "the explicit midpoint rule, for teaching: undamped oscillations grow slowly",
       &kMidpointTableau, makeExplicitRungeKutta},
      {"Runge-Kutta-4", 4, 4, StepControl::kFixed, 2.785293563405282, 2.8284271247461903,
       "W. Kutta, Z. Math. Phys. 46 (1901) 435-453",
       "the best choice with a fixed step, unless particles are very light",
       &kClassicalRungeKuttaTableau, makeExplicitRungeKutta},
      {"Semi-Implicit-Euler", 1, 1, StepControl::kFixed, 2.0, 2.0,
       "E. Hairer, C. Lubich, G. Wanner, Acta Numer. 12 (2003) 399-450, "
       "doi:10.1017/S0962492902000144",
       "symplectic without damping: inaccurate, but the energy error stays bounded; common in "
       "games",
       nullptr, makeFixedStep<SemiImplicitEuler>, true, 80},
      {"Velocity-Verlet", 2, 2, StepControl::kFixed, 2.0, 2.0,
       "W. C. Swope and others, J. Chem. Phys. 76 (1982) 637-649, doi:10.1063/1.442716",
       "symplectic and reversible without damping: for very long undamped runs", nullptr,
       makeFixedStep<VelocityVerlet>, true, 130},
      {"Backward-Euler", 1, 1, StepControl::kFixed, kUnlimited, kUnlimited,
       "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, Springer 1996, section "
       "IV.3",
       "implicit, for teaching: no stability limit, but it loses energy; common in graphics",
       nullptr, makeFixedStep<BackwardEuler>, false, 280},
      {"Dormand-Prince-5", 5, 6, StepControl::kErrorControlled, 3.3065678926, 0.9971890107,
       "J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19-26, "
       "doi:10.1016/0771-050X(80)90013-3",
       "the best-known embedded pair, for comparison", &kDormandPrince5.tableau,
       makeErrorControlled<EmbeddedRungeKuttaStepper>, false, 430},
      {"Taylor-8", 8, 8, StepControl::kErrorControlled, kTaylor8RealStabilityLimit,
       3.3951402205749246,
       "Å. Jorba, M. Zou, Exp. Math. 14 (2005) 99-117, doi:10.1080/10586458.2005.10128904",
       "where stability limits the step, as with light particles and coarse tolerances", nullptr,
       makeErrorControlled<TaylorStepper, 8>, false, 850},
      {"Taylor-12", 12, 12, StepControl::kErrorControlled, kTaylor12RealStabilityLimit,
       3.3793773141575327,
       "Å. Jorba, M. Zou, Exp. Math. 14 (2005) 99-117, doi:10.1080/10586458.2005.10128904",
       "usually the fastest, unless particles are very light", nullptr,
       makeErrorControlled<TaylorStepper, 12>, false, 880},
      {"Stabilized-Taylor-4", 4, 4, StepControl::kErrorControlled, 32.4192, 2.8284271247461903,
       "D. I. Ketcheson, A. J. Ahmadia, Commun. Appl. Math. Comput. Sci. 7 (2012) 247-271, "
       "doi:10.2140/camcos.2012.7.247",
       "for light particles (k_d/m of 1e2/s to 1e4/s) and coarse tolerances", nullptr,
       makeErrorControlled<StabilizedTaylorStepper, 4>, false, 980},
      {"Stabilized-Taylor-8", 8, 8, StepControl::kErrorControlled, 25.3505, 3.3951402205749246,
       "D. I. Ketcheson, A. J. Ahmadia, Commun. Appl. Math. Comput. Sci. 7 (2012) 247-271, "
       "doi:10.2140/camcos.2012.7.247",
       "for light particles (k_d/m of 1e2/s to 1e4/s)", nullptr,
       makeErrorControlled<StabilizedTaylorStepper, 8>, false, 1050},
      {"Radau-9", 9, 5, StepControl::kErrorControlled, kUnlimited, kUnlimited,
       "E. Hairer, G. Wanner, J. Comput. Appl. Math. 111 (1999) 93-111, "
       "doi:10.1016/S0377-0427(99)00134-X",
       "implicit, with the spring tensions as unknowns: for very light particles (k_d/m beyond "
       "1e4/s), down to 1e-9 kg, or stiff springs whose vibrations are below the tolerance",
       nullptr, makeErrorControlled<RadauStepper>, false, 1190},
      {"Auto", 8, 8, StepControl::kErrorControlled, kUnlimited, kUnlimited,
       "L. Petzold, SIAM J. Sci. Stat. Comput. 4 (1983) 136-148, doi:10.1137/0904010",
       "chooses among the Taylor methods and Radau-9 as the motion requires, and reports its "
       "choice",
       nullptr, makeErrorControlled<AutoStepper>, false, 2250},
  };
}

constexpr int kMostOrder = 10;
/// Violation of an order condition that rounded coefficients may have.
constexpr double kRounding = 1e-12;
/// Growth per step that counts as none.
constexpr double kNoGrowth = 1e-12;
constexpr double kScanStep = 0.01;
constexpr double kLargestLimit = 1000.0;

int orderOf(const ButcherTableau& tableau) {
  int order = 0;
  while (order < kMostOrder && orderConditionResidual(tableau, tableau.b, order + 1) <= kRounding)
    ++order;
  return order;
}

/// Returns the largest h|λ| up to which no mode λ of this direction grows; 0: none.
double stabilityLimit(const ButcherTableau& tableau, std::complex<double> direction) {
  const auto is_stable = [&](double size) {
    return growthOf(stabilityIncrement(tableau, size * direction)) <= kNoGrowth;
  };
  double stable = 0.0;
  while (stable < kLargestLimit && is_stable(stable + kScanStep)) stable += kScanStep;
  if (stable == 0.0) return 0.0;
  double unstable = stable + kScanStep;
  while (unstable - stable > 1e-12 * unstable) {
    const double middle = 0.5 * (stable + unstable);
    (is_stable(middle) ? stable : unstable) = middle;
  }
  return stable;
}

/// Factor by which the forces and the motion amplify the rounding errors of the steps.
constexpr double kRoundingErrors = 100.0;

std::deque<Method>& mutableMethodTable() {
  static std::deque<Method> table = builtInMethods();
  return table;
}

void checkMethod(const Method& method) {
  const auto refuse = [&](std::string_view what) {
    throw InputError(fmt::format("method '{}': {}", method.name, what));
  };
  if (isSameName(method.name, "")) throw InputError("a method needs a name of letters or digits");
  for (const Method& known : methodTable())
    if (isSameName(known.name, method.name)) refuse("a method of this name exists");
  if (method.order < 1) refuse("order must be at least 1");
  if (method.stages < 1) refuse("stages must be at least 1");
  if (!(method.bytes_per_particle >= 0.0)) refuse("bytes_per_particle must be at least 0");
  if (!(method.real_stability_limit >= 0.0) || !(method.imaginary_stability_limit >= 0.0))
    refuse("stability limits must be at least 0");
  if (method.tableau == nullptr && !method.make) refuse("needs a tableau or a factory");
  if (method.tableau == nullptr) return;
  checkTableau(method.name, *method.tableau);
  if (!method.make && !method.hasFixedStep())
    refuse("a tableau without a factory is a fixed-step method");
  if (!method.make && static_cast<std::size_t>(method.stages) != method.tableau->stages)
    refuse("stages must equal the stages of the tableau");
}

/// Names of other methods and programs, and the method here that is nearest. The first two are accepted.
constexpr std::pair<std::string_view, std::string_view> kOtherNames[] = {
    {"RK2", "Runge-Kutta-2"},
    {"RK4", "Runge-Kutta-4"},
    {"BDF", "Radau-9"},
    {"DOP853", "Taylor-8"},
    {"Heun", "Runge-Kutta-2"},
    {"Implicit-Euler", "Backward-Euler"},
    {"Leapfrog", "Velocity-Verlet"},
    {"LSODA", "Auto"},
    {"Midpoint", "Runge-Kutta-2"},
    {"ode45", "Dormand-Prince-5"},
    {"RK45", "Dormand-Prince-5"},
    {"Symplectic-Euler", "Semi-Implicit-Euler"},
    {"Verlet", "Velocity-Verlet"},
};

std::vector<std::string> methodNames() {
  std::vector<std::string> names;
  for (const Method& method : methodTable()) names.push_back(method.name);
  return names;
}

}  // namespace

const std::deque<Method>& methodTable() {
  return mutableMethodTable();
}

void registerMethod(const Method& method) {
  static std::deque<ButcherTableau> tableaus;
  checkMethod(method);
  Method row = method;
  if (row.tableau != nullptr) row.tableau = &tableaus.emplace_back(*method.tableau);
  if (!row.make) row.make = makeExplicitRungeKutta;
  mutableMethodTable().push_back(std::move(row));
}

std::string knownMethodNames() {
  return fmt::format("{}", fmt::join(methodNames(), ", "));
}

const Method& findMethod(std::string_view name) {
  for (const Method& method : methodTable())
    if (method.name == name) return method;
  for (const Method& method : methodTable())
    if (isSameName(method.name, name)) return method;
  std::string meant;
  for (const auto& other : kOtherNames) {
    if (!isSameName(other.first, name)) continue;
    if (&other < kOtherNames + 2) return findMethod(other.second);
    meant = other.second;
  }
  throw InputError(unknownName("method", name, methodNames(), meant));
}

std::unique_ptr<Integrator> makeIntegrator(const Method& method, const Chain& chain,
                                           const IntegratorOptions& options) {
  if (chain.size() < 1) throw InputError("the chain has no particles: it was moved from");
  if (!method.hasFixedStep()) requirePositive("tolerance", options.tolerance, "m");
  requireAtLeastZero("threads", options.threads);
  if (!method.make)
    throw InputError(
        fmt::format("method '{}' has no factory: register it with registerMethod", method.name));
  std::unique_ptr<Integrator> integrator = method.make(method, chain, options);
  if (!integrator)
    throw InputError(fmt::format("the factory of method '{}' returned no integrator", method.name));
  return integrator;
}

std::unique_ptr<Integrator> makeIntegrator(std::string_view method, const Chain& chain,
                                           const IntegratorOptions& options) {
  return makeIntegrator(findMethod(method), chain, options);
}

void checkTableau(std::string_view method, const ButcherTableau& tableau) {
  if (tableau.stages < 1 || tableau.stages > ButcherTableau::kMaxStages)
    throw InputError(fmt::format("tableau of method '{}' has {} stages: must be 1 to {}", method,
                                 tableau.stages, ButcherTableau::kMaxStages));
  for (std::size_t i = 0; i < tableau.stages; ++i) {
    bool explicit_row = std::isfinite(tableau.b[i]);
    for (std::size_t j = 0; j < tableau.stages; ++j)
      explicit_row =
          explicit_row && (j < i ? std::isfinite(tableau.a[i][j]) : tableau.a[i][j] == 0.0);
    if (explicit_row) continue;
    throw InputError(
        fmt::format("stage {} of the tableau of method '{}': coefficients must be finite, and 0 on "
                    "and above the diagonal",
                    i + 1, method));
  }
  if (orderConditionResidual(tableau, tableau.b, 1) <= kRounding) return;
  throw InputError(fmt::format("method '{}': the weights b must add up to 1", method));
}

Method methodOfTableau(const std::string& name, const ButcherTableau& tableau) {
  checkTableau(name, tableau);
  Method method;
  method.name = name;
  method.order = orderOf(tableau);
  method.stages = static_cast<int>(tableau.stages);
  method.real_stability_limit = stabilityLimit(tableau, -1.0);
  method.imaginary_stability_limit = stabilityLimit(tableau, {0.0, 1.0});
  method.tableau = &tableau;
  return method;
}

double smallestTolerance(const Chain& chain, const State& start) {
  const double length = chain.spring().rest_length * static_cast<double>(chain.size() - 1);
  double largest = std::abs(chain.gravity());  // times (1 s)²: a length in m
  for (Eigen::Index i = 0; i < start.values().size(); ++i)
    largest = std::max(largest, std::abs(start.values().data()[i]));
  return kRoundingErrors * std::numeric_limits<double>::epsilon() * std::max(length, largest);
}

void checkTolerance(double tolerance, const Chain& chain, const State& start) {
  const double least = smallestTolerance(chain, start);
  if (tolerance >= least) return;
  if (std::isinf(least))
    throw InputError(
        "rest_length, positions or velocities are too large: no tolerance exceeds their rounding "
        "errors");
  throw InputError(
      fmt::format("tolerance: must be at least {:.1e} m for this scene, because of the rounding "
                  "errors; got {}",
                  1.05 * least, numberText(tolerance)));
}

}  // namespace spring_pendulum

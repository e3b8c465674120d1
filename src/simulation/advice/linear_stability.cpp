#include "simulation/advice/linear_stability.hpp"

#include "base/checks.hpp"
#include "integration/tableau.hpp"
#include "integration/taylor/stabilized_polynomials.hpp"
#include "model/chain_modes.hpp"
#include "simulation/judge.hpp"
#include <spring_pendulum/simulation/outcome.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

namespace spring_pendulum {
namespace {

using Complex = std::complex<double>;

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Returns ln |R(z)|. Without a tableau, R is 1/(1 - z) of the implicit Euler method, exp(z) of other methods
/// without limits, or the Taylor series; of the stabilized ones that with the smallest |R|.
double growthOf(const Method& method, Complex z) {
  if (method.tableau != nullptr)
    return spring_pendulum::growthOf(stabilityIncrement(*method.tableau, z));
  if (std::isinf(method.imaginary_stability_limit))
    return method.order == 1 ? -std::log(std::abs(1.0 - z)) : z.real();
  const int order = std::min(method.order, static_cast<int>(ButcherTableau::kMaxStages));
  const std::initializer_list<StabilizedPolynomial> plain{{order, order, 0.0, {}, {}}};
  const bool stabilized = method.name.rfind("Stabilized-", 0) == 0;
  double growth = kUnlimited;
  for (const StabilizedPolynomial& series : stabilized ? stabilizedPolynomials(order) : plain) {
    Complex sum = 0.0, term = 1.0;
    for (int i = 1; i <= series.terms; ++i) sum += series.weight(i) * (term *= z / (1.0 * i));
    growth = std::min(growth, spring_pendulum::growthOf(sum));
  }
  return growth;
}

/// Returns ln of the spectral radius of a symplectic method, with hω and hc scaled so that its limits are
/// 2: z² - 2 (1 + e) z + 1 - a + s - m = 0, where s = m = 0 but for Velocity-Verlet.
double growthFromLimits(const Method& method, double swing, double decay) {
  const double a = 2.0 * decay / method.real_stability_limit;
  const double b = std::pow(2.0 * swing / method.imaginary_stability_limit, 2);
  const bool verlet = method.name == "Velocity-Verlet";
  const double s = verlet ? 0.5 * a * a : 0.0, m = verlet ? 0.25 * a * b : 0.0;
  const double e = -0.5 * (a + b - s - m);
  const double discriminant = e * e - b + 2.0 * m;
  if (discriminant < 0.0) return 0.5 * std::log1p(s - m - a);
  return std::log(std::abs(1.0 + e) + std::sqrt(discriminant));
}

/// Returns the largest step size in s for a mode with k = frequency² and c = damping; see the header.
double stepForMode(const Method& method, double frequency, double damping, double duration) {
  constexpr double kMostSteps = 1e12;  // rounding errors of ln |R| add up
  const double rate = std::max(frequency, damping);
  if (rate == 0.0) return kUnlimited;
  if (!std::isfinite(frequency) || !std::isfinite(damping)) return 0.0;
  const double allowed = 0.5 * std::log1p(Judge::kGainThreshold);
  const auto passes = [&](double step) {
    const double steps = std::clamp(duration * rate / step, 1.0, kMostSteps);
    return steps * growthPerStep(method, step * frequency / rate, step * damping / rate) <= allowed;
  };
  double good = 1e-9, bad = 1e9;
  if (!passes(good)) return 0.0;
  if (passes(bad)) return kUnlimited;
  while (bad > 1.00001 * good) {
    const double middle = std::sqrt(good * bad);
    (passes(middle) ? good : bad) = middle;
  }
  return good / rate;
}

}  // namespace

double growthPerStep(const Method& method, double swing, double decay) {
  if (method.tableau == nullptr && method.hasFixedStep() &&
      std::isfinite(method.imaginary_stability_limit) && method.imaginary_stability_limit > 0.0)
    return growthFromLimits(method, swing, decay);
  const double center = -0.5 * decay;
  const double discriminant = center * center - swing * swing;
  const double radius = std::sqrt(std::abs(discriminant));
  if (discriminant < 0.0) return growthOf(method, {center, radius});
  return std::max(growthOf(method, center - radius), growthOf(method, center + radius));
}

double springStepLimit(const Method& method, const Chain& chain, double duration) {
  return stepForMode(method, fastestVibration(chain), largestDampingRate(chain), duration);
}

bool isClearlyUnstable(const Method& method, const Chain& chain, double time_step,
                       double duration) {
  // The limits of a registered method without a tableau may be too small.
  if (chain.airDrag() != 0.0) return false;  // it may damp the spring more or less than others
  const double mode = stiffestSpring(chain);
  const double frequency = std::sqrt(chain.spring().stiffness * mode);
  const double damping = chain.spring().damping * mode;
  if (!std::isfinite(frequency) || !std::isfinite(damping)) return false;
  const double step = 0.6 * time_step;
  const double growth = growthPerStep(method, step * frequency, step * damping);
  // Not a number if |R|² exceeds the range of double.
  return !(std::min(duration / time_step, 500.0) * growth < std::log(1e8));
}

double linearStepLimit(const Method& method, const Chain& chain, double duration) {
  requirePositive("duration", duration, "s");
  if (!method.hasFixedStep() || stiffestSpring(chain) == 0.0) return kUnlimited;
  // Transverse motion is undamped. The tension acts as a stiffness below k_s; for methods that are
  // unstable on the imaginary axis, the slowest mode, which has most of the energy, counts.
  const double swing =
      method.imaginary_stability_limit > 0.0 ? fastestVibration(chain) : slowSwing(chain);
  constexpr double kMargin = 0.25;  // measured: 0.35 is too much for Euler with mixed masses
  return kMargin * std::min(springStepLimit(method, chain, duration),
                            stepForMode(method, swing, 0.0, duration));
}

}  // namespace spring_pendulum

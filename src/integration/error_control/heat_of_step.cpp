#include "integration/error_control/heat_of_step.hpp"

#include <spring_pendulum/model/energy.hpp>

#include <array>

namespace spring_pendulum {
namespace {

struct QuadraturePoint {
  double node;  ///< on [-1, 1]
  double weight;
};

// M. Abramowitz, I. A. Stegun, Handbook of Mathematical Functions, table 25.4.
constexpr std::array<QuadraturePoint, 6> kGaussLegendre{
    {{-0.932469514203152028, 0.171324492379170345},
     {-0.661209386466264514, 0.360761573048138608},
     {-0.238619186083196909, 0.467913934572691047},
     {0.238619186083196909, 0.467913934572691047},
     {0.661209386466264514, 0.360761573048138608},
     {0.932469514203152028, 0.171324492379170345}}};

}  // namespace

double heatOfStep(const AdaptiveStepper& stepper, const Chain& chain, double length,
                  double fraction, State& scratch) {
  double sum = 0.0;
  for (const QuadraturePoint& point : kGaussLegendre) {
    stepper.interpolate(0.5 * fraction * (1.0 + point.node), scratch);
    sum += point.weight * dissipatedPower(chain, scratch);
  }
  return 0.5 * fraction * length * sum;
}

}  // namespace spring_pendulum

#include "integration/implicit/linear_spring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace spring_pendulum {
namespace {

using Vector = PlaneVector<double>;

constexpr Vector kSeparation{0.7, -0.4};
constexpr Vector kApproach{1.3, -0.8};

// Largest difference of the linearised force to central differences of the spring law, per k_s.
double errorOfForce(const SpringLaw& law) {
  const LinearSpring spring =
      linearSpring(law, kSeparation, kApproach, springTension(law, kSeparation, kApproach));
  const double step = 1e-6;
  double largest = 0.0;
  for (const Vector& d : {Vector{step, 0.0}, Vector{0.0, step}}) {
    const auto compare = [&](const Vector& ds, const Vector& dw, const Vector& change) {
      const Vector above = springForce(law, Vector{kSeparation.x + ds.x, kSeparation.y + ds.y},
                                       Vector{kApproach.x + dw.x, kApproach.y + dw.y});
      const Vector below = springForce(law, Vector{kSeparation.x - ds.x, kSeparation.y - ds.y},
                                       Vector{kApproach.x - dw.x, kApproach.y - dw.y});
      largest = std::max({largest, std::abs((above.x - below.x) / 2.0 - change.x) / step,
                          std::abs((above.y - below.y) / 2.0 - change.y) / step});
    };
    compare(d, {}, spring.stiffnessTimes(d));
    const double tension = spring.tensionChange(law.damping, {}, d);
    compare({}, d, {tension * spring.r.x, tension * spring.r.y});
  }
  return largest / law.stiffness;
}

TEST(LinearSpring, AgreesWithFiniteDifferences) {
  for (const SpringLaw& law : {SpringLaw{}, {2e3, 30.0, 0.4}, {50.0, 0.0, 1.0}, {50.0, 10.0, 0.0}})
    EXPECT_LT(errorOfForce(law), 1e-9);  // 1.1e-10
}

}  // namespace
}  // namespace spring_pendulum

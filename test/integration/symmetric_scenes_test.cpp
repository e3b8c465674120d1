// Symmetric scenes, in which coefficients of the motion vanish, with every error-controlled method.
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace spring_pendulum {
namespace {

enum class Shape { kLevel, kVertical, kMirrored };

struct SymmetricCase {
  Shape shape;
  Eigen::Index size;
  bool held_at_both_ends;
  double mass;     // kg
  double damping;  // N·s/m
  double spacing;  // m
  double gravity;  // m/s²
};

State startOf(const SymmetricCase& c) {
  State state(c.size);
  for (Eigen::Index i = 0; i < c.size; ++i) {
    const auto along = static_cast<double>(i);
    const auto from_end = static_cast<double>(std::min(i, c.size - 1 - i));
    if (c.shape != Shape::kVertical) state.x()[i] = c.spacing * along;
    if (c.shape == Shape::kVertical) state.y()[i] = -c.spacing * along;
    if (c.shape == Shape::kMirrored) state.y()[i] = -c.spacing * from_end;
  }
  return state;
}

std::string description(const SymmetricCase& c) {
  return "shape " + std::to_string(static_cast<int>(c.shape)) + ", " + std::to_string(c.size) +
         (c.held_at_both_ends ? " particles held, " : " particles, ") + std::to_string(c.mass) +
         " kg, k_d " + std::to_string(c.damping) + ", " + std::to_string(c.spacing) + " m, g " +
         std::to_string(c.gravity);
}

// 864 runs per method. The reference has another step-size control, so gaps do not mislead both.
void expectTheTolerance(const SymmetricCase& c) {
  Chain chain(Eigen::VectorXd::Constant(c.size, c.mass), SpringLaw{50.0, c.damping, 1.0},
              c.gravity);
  if (c.held_at_both_ends) chain = chain.drivenBy({{{c.size - 1, {}}}, {}});
  for (const double time : {0.002, 0.1}) {  // s; the former shows the first step
    State exact = startOf(c);
    makeIntegrator("Dormand-Prince-5", chain, {1e-12})->advance(exact, time, 1);
    for (const Method& method : methodTable()) {
      if (method.hasFixedStep()) continue;
      for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
        State state = startOf(c);
        makeIntegrator(method, chain, {tolerance})->advance(state, time, 1);
        EXPECT_LT((state.positions() - exact.positions()).rowwise().norm().maxCoeff(),
                  10.0 * tolerance)
            << method.name << " " << tolerance << " m, " << time << " s, " << description(c);
      }
    }
  }
}

TEST(SymmetricScenes, KeepTheTolerance) {
  for (const Shape shape : {Shape::kLevel, Shape::kVertical, Shape::kMirrored})
    for (const Eigen::Index size : {2, 3, 4, 7})
      for (const bool held : {false, true}) {
        if (held && size == 2) continue;
        for (const double mass : {1.0, 0.01})
          for (const double spacing : {0.7, 1.0, 1.3}) {
            expectTheTolerance({shape, size, held, mass, 1.0, spacing, 9.81});
            expectTheTolerance({shape, size, held, mass, 0.0, spacing, 9.81});
            expectTheTolerance({shape, size, held, mass, 1.0, spacing, 0.0});
          }
      }
}

}  // namespace
}  // namespace spring_pendulum

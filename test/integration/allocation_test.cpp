// Nothing is allocated while stepping. Every allocation of this program is counted: those of `new`
// and those of Eigen, which calls malloc. Sanitizers replace malloc, so this test is skipped there.
#include "integration/fixed_step/explicit_runge_kutta.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {
std::atomic<long> allocations{0};
}  // namespace

// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming): the C library's name
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* malloc(std::size_t size) noexcept {  // what the rest of the program calls
  ++allocations;
  return __libc_malloc(size);
}

namespace spring_pendulum {
namespace {

State hangingChain(Eigen::Index size) {
  State state(size);
  state.y() = -1.1 * Eigen::VectorXd::LinSpaced(size, 0.0, static_cast<double>(size - 1));
  return state;
}

TEST(Allocation, IsCounted) {
  const long before = allocations;
  const Eigen::VectorXd numbers(100);
  EXPECT_GT(allocations, before) << numbers.size();
}

TEST(Allocation, DoesNotHappenWhileAnyMethodSteps) {
  const Chain chain(Eigen::VectorXd::Ones(11), SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    const auto integrator = makeIntegrator(method, chain);
    State state = hangingChain(11);
    const long before = allocations;
    integrator->advance(state, 0.01, 5);
    integrator->advance(state, 0.01, 50);
    EXPECT_EQ(allocations, before) << method.name;
  }
}

TEST(Allocation, DoesNotHappenWhileThreadsStepALongChain) {
  const Chain chain(Eigen::VectorXd::Ones(5000), SpringLaw{}, 9.81);
  ExplicitRungeKutta engine(chain, kClassicalRungeKuttaTableau, {1e-6, false, 3}, {1024, 1e-9});
  State state = hangingChain(5000);
  const long before = allocations;
  engine.advance(state, 0.01, 3);
  engine.advance(state, 0.01, 40);
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace spring_pendulum

#endif

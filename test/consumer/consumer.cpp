// A program that owns, copies, moves and resizes what the library allocates, and the other way
// round. consumer_test.sh compiles it with other options than the library.
#include <spring_pendulum/spring_pendulum.hpp>

#include <cstdio>
#include <utility>
#include <vector>

namespace {

using namespace spring_pendulum;

int failures = 0;

void expect(bool true_value, const char* text) {
  if (true_value) return;
  std::fprintf(stderr, "not true: %s\n", text);
  ++failures;
}

void tradeMemory() {
  Scene particles = parseParticles("0 0 1\n1 0 1\n2 0 1\n3 0 1\n4 0 1\n", "text");
  const Chain chain(particles.masses, SpringLaw{}, 9.81);
  const Chain equal(Eigen::VectorXd::Ones(5), SpringLaw{}, 9.81);
  expect((chain.masses() == equal.masses()), "masses agree");
  std::vector<State> states(3, particles.state);
  for (int n = 0; n < 9; ++n) {
    states.push_back(states.front());
    State slope;
    computeSlope(chain, states.back(), slope);  // allocated by the library
    states.back().values() += 1e-3 * slope.values();
    slope = State(2 + n);  // freed by the program
  }
  State moved = std::move(states.back());
  moved = particles.state;
  particles = parseParticles("0 0 1\n1 0 1\n", "text");
  Chain copy = chain;
  copy = Chain(Eigen::VectorXd::Constant(particles.state.size(), 2.0), SpringLaw{}, 0.0);
  expect(copy.size() == 2 && moved.size() == 5, "sizes agree");
}

void runEveryMethod() {
  const Scene particles = parseParticles("0 0 1\n1 0 1\n2 0 0.5\n", "text");
  const Chain chain(particles.masses, SpringLaw{}, 9.81);
  for (const Method& method : methodTable()) {
    State state = particles.state;
    const auto integrator = makeIntegrator(method, chain);
    integrator->advance(state, 0.001, 500);
    expect(state.values().allFinite() && state.y()[2] < -0.5, "the chain fell");
    expect(computeEnergy(chain, state).kinetic > 0.0, "the chain moves");
  }
}

}  // namespace

int main() {
  tradeMemory();
  runEveryMethod();
  return failures == 0 ? 0 : 1;
}

// Integrates a particle file with Auto and prints where the end of the chain is.
#include <spring_pendulum/spring_pendulum.hpp>

#include <iostream>

int main(int argc, char** argv) try {
  using namespace spring_pendulum;
  Particles particles = readParticleFile(argc > 1 ? argv[1] : "particle.txt");
  const Chain chain(particles.masses, SpringLaw{50.0, 1.0, 1.0}, 9.81);
  const auto integrator = makeIntegrator("Auto", chain, {1e-6});  // tolerance in m

  State& state = particles.state;
  for (int second = 1; second <= 10; ++second) {
    integrator->advance(state, 1.0, 1);
    if (!state.values().allFinite()) throw InputError("the motion diverged");
    std::cout << second << " s: " << state.positions().bottomRows(1) << " m\n";
  }
  return 0;
} catch (const std::exception& error) {  // InputError: what is wrong; FileError: which file
  std::cerr << error.what() << '\n';
  return 1;
}

// Integrates a particle file with Auto and prints where the end of the chain is.
#include <spring_pendulum/spring_pendulum.hpp>

#include <iostream>

int main(int argc, char** argv) try {
  using namespace spring_pendulum;
  Scene scene = readParticleFile(argc > 1 ? argv[1] : "particle.txt");
  scene.constants.spring.stiffness = 50.0;  // N/m

  const auto integrator = makeIntegrator("Auto", scene.chain(), {1e-6});  // tolerance in m
  State& state = scene.state;
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

// Runs a particle file with Runge-Kutta-4 and prints what the run measured about itself.
#include <spring_pendulum/spring_pendulum.hpp>

#include <iostream>

int main(int argc, char** argv) try {
  using namespace spring_pendulum;
  Run run(readParticleFile(argc > 1 ? argv[1] : "particle.txt"), Plan{});
  while (run.advance()) {
  }
  std::cout << run.closingLine() << '\n' << run.verdict().text << '\n';
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}

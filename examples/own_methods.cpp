// Runs two methods that the library does not know beside one that it does.
#include "own_methods.hpp"

#include <iostream>

int main() {
  using namespace spring_pendulum;
  registerOwnMethods();
  const Chain chain(Eigen::VectorXd::Ones(2), SpringLaw{}, 9.81);
  for (const char* name : {"Ralston", "Heun", "Runge-Kutta-4"}) {
    State state(2);
    state.x()[1] = 1.0;
    makeIntegrator(name, chain)->advance(state, 0.01, 1000);
    std::cout << name << ": " << state.positions().row(1) << " m after 10 s\n";
  }
}

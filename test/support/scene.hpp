// A chain and its initial state.
#pragma once

#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/state.hpp>

#include <string>

namespace spring_pendulum::test {

struct Scene {
  std::string name;
  Chain chain;
  State start;
};

/// Returns the same chain with another air drag, in N·s/m.
inline Chain inAir(const Chain& chain, double air_drag) {
  Constants constants = chain.constants();
  constants.air_drag = air_drag;
  return {chain.masses(), constants};
}

}  // namespace spring_pendulum::test

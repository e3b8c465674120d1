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

}  // namespace spring_pendulum::test

// Exercise3 run as a program in a folder of its own.
#pragma once

#include <string>
#include <vector>

#include "support/process.hpp"

namespace spring_pendulum {

/// Two particles of 1 kg, a metre apart.
inline constexpr const char* kTwoParticles = "0 0 1\n1 0 1\n";

/// The file of a horizontal chain, a metre between neighbours.
inline std::string chainOf(int particles, const std::string& mass = "1") {
  std::string text;
  for (int i = 0; i < particles; ++i) text += std::to_string(i) + " 0 " + mass + "\n";
  return text;
}

inline Command exercise3(const TemporaryFolder& folder, const std::vector<std::string>& options) {
  Command command{{EXERCISE3}, folder.path(), {}, {}};
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  return command;
}

}  // namespace spring_pendulum

// The main function of all benchmarks, each of which defines run().
#include <cstdio>
#include <exception>
#include <sstream>
#include <stdexcept>

#include "options.hpp"

namespace spring_pendulum::benchmark {
namespace {

Options parseOptions(int count, char** words) {
  Options options;
  for (int i = 1; i < count; i += 2) {
    const std::string key = words[i];
    if (i + 1 == count) throw std::invalid_argument(key + " needs a value");
    const std::string value = words[i + 1];
    if (key == "--output") {
      options.output = value;
    } else if (key == "--scene") {
      options.scene = value;
    } else if (key == "--peer") {
      options.peer = value;
    } else if (key == "--particles") {
      std::istringstream lengths(value);
      for (std::string length; std::getline(lengths, length, ',');) {
        options.particles.push_back(std::stoul(length));
      }
    } else if (key == "--limit") {
      options.limit = std::stod(value);
    } else if (key == "--budget") {
      options.budget = std::stod(value);
    } else if (key == "--passes") {
      options.passes = std::stoi(value);
    } else if (key == "--busy-sibling") {
      options.busy_sibling = value == "1";
    } else if (key == "--smoke") {
      options.smoke = value == "1";
    } else {
      throw std::invalid_argument("unknown option " + key);
    }
  }
  return options;
}

}  // namespace
}  // namespace spring_pendulum::benchmark

int main(int count, char** words) {
  using namespace spring_pendulum::benchmark;
  try {
    return run(parseOptions(count, words));
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

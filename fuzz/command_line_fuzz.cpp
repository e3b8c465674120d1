// Arbitrary arguments, one per line, give a valid scenario, an answer, or an error.
#include "io/program/command_line.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <string>
#include <vector>

#include "fuzz_target.hpp"

namespace {

using namespace spring_pendulum;

/// Splits text into arguments at newlines; removes zero bytes.
std::vector<std::string> argumentsFrom(const std::string& text) {
  std::vector<std::string> arguments{"Exercise3"};
  std::string argument;
  for (const char c : text) {
    if (c == '\0') continue;
    if (c != '\n') {
      argument += c;
      continue;
    }
    arguments.push_back(argument);
    argument.clear();
  }
  if (!argument.empty()) arguments.push_back(argument);
  return arguments;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::string> arguments = argumentsFrom(std::string(data, data + size));
  std::vector<const char*> pointers;
  pointers.reserve(arguments.size());
  for (const std::string& argument : arguments) pointers.push_back(argument.c_str());
  try {
    Scenario scenario;
    OptionSet options(scenarioOptions(scenario));
    const Switches switches = parseCommandLine(static_cast<int>(pointers.size()), pointers.data(),
                                               {"Exercise3", "", ""}, options, scenario);
    if (!switches.answer.empty()) return 0;
    require(scenario.frames >= 1 && scenario.time_step > 0.0, "values in range");
  } catch (const InputError& error) {
    require(*error.what() != '\0', "a message");
  } catch (const FileError& error) {  // --config
    require(*error.what() != '\0', "a message");
  }
  return 0;
}

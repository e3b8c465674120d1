// Writes the messages of a run straight into a bag: no master, no waiting, simulated time as
// stamps, the same bytes in every run.
#include "io/command_line.hpp"
#include "io/failure.hpp"
#include "ros/bag_recorder.hpp"
#include <spring_pendulum/model/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr std::string_view kUsage =
    "Writes the messages that pendulum_node publishes straight into a bag.\n"
    "Usage: record_bag METHOD [--bag FILE] [OPTIONS]\n\n"
    "  --bag FILE          the bag to write [pendulum.bag]\n"
    "  --namespace NAME    put before the topics markers, state and status []\n"
    "  --append            add to a bag that is there, for example another method's run\n";

std::string optionName(std::string_view key) {
  std::string name = fmt::format("--{}", key);
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

std::string help(const std::string& scenario_help) {
  std::string text(kUsage);
  for (const NodeOption& option : nodeOptionTable()) {
    if (!option.for_bags) continue;
    text += fmt::format("  {:<19} {} [{}{}{}]\n", optionName(option.key), option.meaning,
                        formatValue(option, NodeOptions{}), option.unit.empty() ? "" : " ",
                        option.unit);
  }
  return text + "\nAnd the options of Exercise3, of which --output has no meaning here:\n\n" +
         scenario_help;
}

struct Arguments {
  BagOptions bag;
  NodeOptions options;
  std::vector<const char*> others;  ///< for the command line of Exercise3
};

/// The key of an option of the display, empty if it is none.
std::string_view displayKey(std::string_view argument) {
  for (const NodeOption& option : nodeOptionTable()) {
    if (option.for_bags && argument == optionName(option.key)) return option.key;
  }
  return "";
}

Arguments sortArguments(int argc, const char* const* argv) {
  Arguments arguments;
  for (int i = 0; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const std::string_view key = displayKey(argument);
    if (argument == "--append") {
      arguments.bag.append = true;
    } else if (argument == "--bag" || argument == "--namespace" || !key.empty()) {
      if (++i == argc) throw InputError(fmt::format("{} needs a value, see --help", argument));
      if (argument == "--bag") arguments.bag.path = argv[i];
      if (argument == "--namespace") arguments.bag.name_space = argv[i];
      if (!key.empty()) setNodeOption(arguments.options, key, argv[i], argument);
    } else {
      arguments.others.push_back(argv[i]);
    }
  }
  return arguments;
}

int record(int argc, const char* const* argv) {
  const auto start = std::chrono::steady_clock::now();
  const Arguments arguments = sortArguments(argc, argv);
  const CommandLine command_line =
      parseCommandLine(static_cast<int>(arguments.others.size()), arguments.others.data());
  if (!command_line.answer.empty()) {
    fmt::print("{}", help(command_line.answer));
    return kDone;
  }
  const BagSummary summary = recordBag(command_line.scenario, arguments.options, arguments.bag);
  fmt::print("{}: {} frames, {} messages, {} bytes in {}, {:.3f} s, verdict: {}\n",
             command_line.scenario.method, summary.frames, summary.messages, summary.bytes,
             summary.path,
             std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
             summary.verdict.text);
  return summary.verdict.kind == VerdictKind::kDiverged ? kDiverged : kDone;
}

}  // namespace
}  // namespace spring_pendulum

int main(int argc, char** argv) {
  using namespace spring_pendulum;
  try {
    return record(argc, argv);
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    std::fprintf(stderr, "%s\n", failure.message.c_str());
    return failure.status;
  }
}

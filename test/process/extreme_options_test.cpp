// Random products of extreme values of the options: what a program refuses, it refuses before it
// touches the output folder.
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <csignal>
#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

constexpr const char* kEarlier = "earlier\n";
constexpr const char* kHugeCount = "4611686018427387904";

const std::vector<std::string> kNumbers{"0",      "5e-324", "1e-320", "1e-300",
                                        "1e-160", "1e-9",   "1",      "1e10",
                                        "1e160",  "1e300",  "1e308",  "1.7976931348623157e308"};
const std::vector<std::string> kCounts{"0", "1", "2", "10", kHugeCount, "9223372036854775807"};
const std::vector<std::string> kScenes{"0 0 1\n", kTwoParticles, "0 0 1\n1 0 1\n2 0 1e-300\n",
                                       "0 0 1\n1e-150 0 1e300\n", "0 0 1\n1e150 0 1\n1e153 1 2\n"};

class ExtremeOptions : public testing::Test {
 protected:
  std::string pick(const std::vector<std::string>& values) {
    return values[random_() % values.size()];
  }

  /// Some of the options with a range, at extreme values.
  std::vector<std::string> randomArguments() {
    const Method& method = methodTable()[random_() % methodTable().size()];
    const std::string frames = random_() % 4 == 0 ? pick(kCounts) : "3";
    std::vector<std::string> arguments{method.name, "--frames", frames, "--output", "o"};
    Scenario scenario;
    for (const Option& option : scenarioOptions(scenario)) {
      const bool is_other =
          option.applies_to ==
          (method.hasFixedStep() ? AppliesTo::kErrorControlled : AppliesTo::kFixedStep);
      if (is_other || option.key == "frames" || random_() % 4 != 0) continue;
      std::string name = "--" + std::string(option.key);
      std::replace(name.begin() + 2, name.end(), '_', '-');
      if (std::holds_alternative<Number>(option.value)) {
        arguments.insert(arguments.end(), {name, pick(kNumbers)});
      } else if (std::holds_alternative<Count>(option.value)) {
        arguments.insert(arguments.end(), {name, pick(kCounts)});
      }
    }
    return arguments;
  }

  /// Runs a program with extreme options until it has ended or written its first frame.
  void check(const std::string& program, const std::vector<std::string>& own_options) {
    const TemporaryFolder folder;
    folder.write("particle.txt", pick(kScenes));
    std::filesystem::create_directory(folder.path("o"));
    folder.write("o/frame_0007.txt", kEarlier);
    folder.write("run.bag", kEarlier);
    Command command = exercise3(folder, randomArguments());
    command.arguments.front() = program;
    command.arguments.insert(command.arguments.end(), own_options.begin(), own_options.end());
    SCOPED_TRACE(testing::PrintToString(command.arguments) + readFile(folder.path("particle.txt")));
    Process process(command);
    try {
      process.waitForFile(folder.path("o/frame_0000.txt"));
      process.sendSignal(SIGTERM);         // it may not end by itself
    } catch (const std::runtime_error&) {  // it has ended
    }
    const Result result = process.wait();
    SCOPED_TRACE(result.errors);
    EXPECT_THAT(result.status, testing::AnyOf(0, 2, 3, 128 + SIGTERM));
    ++(result.status == 2 ? refused_ : accepted_);
    if (result.status != 2) return;
    expectOneLine(result.errors);
    EXPECT_THAT(listFolder(folder.path("o")), testing::ElementsAre("frame_0007.txt"));
    EXPECT_EQ(readFile(folder.path("o/frame_0007.txt")), kEarlier);
    EXPECT_EQ(readFile(folder.path("run.bag")), kEarlier);
  }

  std::mt19937 random_{20261};
  int accepted_ = 0;
  int refused_ = 0;
};

TEST_F(ExtremeOptions, AreRefusedBeforeTheFolderChanges) {
  for (int i = 0; i < 200 && !HasFailure(); ++i) {
    check(EXERCISE3, {});
#ifdef RECORD_BAG
    if (i % 4 == 0) {
      check(RECORD_BAG,
            {"--bag", "run.bag", "--display-rate", pick(kNumbers), "--trail", pick(kNumbers)});
    }
#endif
  }
  EXPECT_GT(accepted_, 40);
  EXPECT_GT(refused_, 40);
}

}  // namespace
}  // namespace spring_pendulum

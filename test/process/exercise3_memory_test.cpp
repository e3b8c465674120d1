// The memory that Exercise3 takes is what it says before the run.
#include "simulation/expected_memory.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <string>
#include <sys/resource.h>
#include <unistd.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

// The memory of this test counts until it becomes Exercise3, so that the short run must need more.
constexpr int kShort = 50000, kLong = 100000;

/// Peak memory of a run over one frame interval, B.
double peakMemory(const TemporaryFolder& folder, const std::string& options) {
  const Result result = run(exercise3(folder, wordsOf(options + " --no-frames --frames 2")));
  EXPECT_EQ(result.status, 0) << result.errors;
  return result.peak_memory;
}

class Exercise3Memory : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers take memory of their own";
#endif
    folder_.write("short.txt", chainOf(kShort));
    folder_.write("long.txt", chainOf(kLong));
    folder_.write("light.txt", chainOf(kLong, "1e-5"));
  }
  TemporaryFolder folder_;
};

TEST_F(Exercise3Memory, IsThatOfTheTableOfMethods) {
  Scenario scenario;
  for (const Method& method : methodTable()) {
    scenario.method = method;
    const std::string interval = method.hasFixedStep() ? "" : " --frame-interval 1e-3";
    const std::string options = method.name + interval + " --reference never -p ";
    const double measured =
        peakMemory(folder_, options + "long.txt") - peakMemory(folder_, options + "short.txt");
    const double expected = expectedMemory(scenario, kLong) - expectedMemory(scenario, kShort);
    EXPECT_LT(measured, 1.3 * expected) << method.name;
    if (method.name == "Auto") continue;  // needs the memory of one method or of two
    EXPECT_GT(measured, 0.7 * expected) << method.name;
  }
}

TEST_F(Exercise3Memory, OfAutoIsThatOfTwoMethodsAlsoWhereItTriesAll) {
  Scenario scenario;
  scenario.method = findMethod("Auto");
  EXPECT_LT(peakMemory(folder_, "Auto light.txt --frame-interval 0.005 --reference never"),
            1.1 * expectedMemory(scenario, kLong));
}

TEST_F(Exercise3Memory, OfCheckIsThatOfOneRunAtATime) {
  const std::string options = "Euler long.txt --reference always";
  EXPECT_LT(peakMemory(folder_, options + " --check"),
            1.5 * peakMemory(folder_, options));  // 1.1 times; two runs: 2.05
}

TEST_F(Exercise3Memory, IsSaidBeforeARunThatIsNotRefused) {
  Scenario scenario;
  scenario.reference = ReferenceUse::kAlways;  // takes its memory after frame 0
  const std::vector<std::string> options{"Runge-Kutta-4", "--particles", "long.txt",
                                         "--frames",      "1",           "--reference",
                                         "always",        "--output"};
  std::vector<std::string> good = options, bad = options;
  good.emplace_back("frames");
  bad.emplace_back("long.txt");
  EXPECT_EQ(run(exercise3(folder_, good)).errors, memoryRemark(scenario, kLong) + "\n");
  EXPECT_EQ(run(exercise3(folder_, bad)).errors,
            folder_.path("long.txt") +
                ": could not be created: it is a file or lies in one; give a folder\n");
}

TEST_F(Exercise3Memory, TooLittleIsOneLine) {
  folder_.write("huge.txt", chainOf(1000000));
  for (const auto& [options, message] :
       {std::pair("Radau-9 long.txt",
                  "not enough memory: Radau-9 takes up to 0.14 GB of memory for 100000 particles, "
                  "but this process can use only 0.06 GB\n"),
        std::pair("Euler huge.txt", "not enough memory\n")}) {
    Command limited = exercise3(folder_, wordsOf(options));
    limited.prepare = [] {
      const rlimit memory{60U << 20U, 60U << 20U};
      if (setrlimit(RLIMIT_AS, &memory) != 0) _exit(1);
    };
    const Result result = run(limited);
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(result.errors, message);
    EXPECT_EQ(listFolder(folder_.path()).size(), 4U);
  }
}

}  // namespace
}  // namespace spring_pendulum

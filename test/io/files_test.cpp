// Files of one writer among many, reading text, and numbers in a foreign locale.
#include "io/files/posix.hpp"
#include "io/formats/frame_writer.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <clocale>
#include <locale>
#include <string>
#include <thread>
#include <vector>

#include "support/parse_scenario.hpp"
#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

TEST(OutputFile, IsCompleteHoweverManyRunsWriteIt) {
  const TemporaryFolder folder;
  const std::string path = folder.path("e.csv");
  std::atomic<int> written{0};
  const auto write = [&](char letter) {
    for (int i = 0; i < 75; ++i) {
      try {
        OutputFile file(path);
        for (int part = 0; part < 5; ++part) file.write(std::string(20'000, letter));
        file.finish();
        ++written;
      } catch (const FileError& error) {
        EXPECT_THAT(error.what(), testing::EndsWith("use a different path for each run"));
      }
      const std::string text = readFile(path);  // empty until the first run has finished
      EXPECT_TRUE(text == std::string(text.size(), text[0]));
      EXPECT_TRUE(text.size() == 100'000U || text.empty()) << text.size();
    }
  };
  std::vector<std::thread> runs;
  for (const char letter : {'a', 'b', 'c', 'd'}) runs.emplace_back(write, letter);
  for (std::thread& run : runs) run.join();
  EXPECT_GT(written, 0);
  EXPECT_EQ(listFolder(folder.path()), std::vector<std::string>{"e.csv"});
}

TEST(TextFile, IsReadToItsEndThoughItsSizeIsNotTold) {
  const std::string path = "/proc/version";  // whose size is reported as 0 bytes
  const std::string text = readTextFile(path);
  EXPECT_EQ(text, readFile(path));
  EXPECT_GT(text.size(), 20U);
}

TEST(TextFile, LosesItsByteOrderMarkAndNothingElse) {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(readTextFile(folder.write("marked", mark + "a" + mark)), "a" + mark);
  EXPECT_EQ(readTextFile(folder.write("short", "\xEF\xBB")), "\xEF\xBB");
  EXPECT_EQ(readTextFile(folder.write("empty", "")), "");
}

/// A program that has switched to a decimal comma.
class DecimalComma : public testing::Test {
 protected:
  void SetUp() override {
    constexpr const char* kGerman = "de_DE.UTF-8";
    ASSERT_NE(std::setlocale(LC_ALL, kGerman), nullptr) << "needs the Debian package locales-all";
    std::locale::global(std::locale(kGerman));
    ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  }
  void TearDown() override { std::locale::global(std::locale::classic()); }
};

TEST_F(DecimalComma, DoesNotChangeWhatIsReadAndWritten) {
  const TemporaryFolder folder;
  const Scene particles =
      readParticleFile(folder.write("particle.txt", "0.5 0 1\n1234.25 0.5 1\n"));
  EXPECT_EQ(particles.state.x()[1], 1234.25);
  FrameWriter(folder.path()).write(0, particles.state);
  EXPECT_EQ(readFile(folder.path("frame_0000.txt")), "0.5 0\n1234.25 0.5\n");
}

TEST_F(DecimalComma, DoesNotChangeParameters) {
  Scenario scenario = test::parseScenario("time_step: 0.125\nframes: 1000\n", "run.yaml");
  EXPECT_EQ(scenario.time_step, 0.125);
  const OptionSet options(scenarioOptions(scenario));
  EXPECT_EQ(options.find("time_step", "").text(), "0.125");
  EXPECT_EQ(options.find("frames", "").text(), "1000");
}

}  // namespace
}  // namespace spring_pendulum

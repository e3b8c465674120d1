// Output files and frames, whoever else writes them; reading text; numbers in a foreign locale.
#include "io/files/posix.hpp"
#include "io/formats/frame_writer.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>
#include <spring_pendulum/io/run_files.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <clocale>
#include <filesystem>
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
  EXPECT_EQ(readTextFile(path), readFile(path));
  EXPECT_GT(readFile(path).size(), 20U);
}

TEST(TextFile, LosesItsByteOrderMarkAndNothingElse) {
  const TemporaryFolder folder;
  const std::string mark = "\xEF\xBB\xBF";
  EXPECT_EQ(readTextFile(folder.write("marked", mark + "a" + mark)), "a" + mark);
  EXPECT_EQ(readTextFile(folder.write("short", "\xEF\xBB")), "\xEF\xBB");
  EXPECT_EQ(readTextFile(folder.write("empty", "")), "");
}

TEST(FrameWriter, NamesGrowAboveFourDigits) {
  EXPECT_EQ(frameName(0), "frame_0000.txt");
  EXPECT_EQ(frameName(42), "frame_0042.txt");
  EXPECT_EQ(frameName(9999), "frame_9999.txt");
  EXPECT_EQ(frameName(10000), "frame_10000.txt");
}

std::string textOfFrame(const State& state) {
  const TemporaryFolder folder;
  FrameWriter writer(folder.path());
  writer.write(0, state);
  writer.finish();
  return readFile(folder.path("frame_0000.txt"));
}

TEST(FrameWriter, WritesTheFewestDigits) {
  State state(4);
  state.x() << 0.0, 0.1, -1.0 / 3.0, 1e-7;
  state.y() << -2.0, 123456.75, 5e-324, -1.7976931348623157e308;
  EXPECT_EQ(textOfFrame(state),
            "0 -2\n0.1 123456.75\n-0.3333333333333333 5e-324\n1e-07 -1.7976931348623157e+308\n");
}

/// Frames of a few particles are written at once, large ones in a thread.
class FrameWriterThread : public testing::TestWithParam<Eigen::Index> {
 protected:
  static constexpr int kFrames = 6;

  static State frame(int index) {
    State state(GetParam());
    state.x().setLinSpaced(0.1 * index, 1.0);
    state.y().setConstant(index / 3.0);
    return state;
  }

  TemporaryFolder folder_;
};

TEST_P(FrameWriterThread, WritesFramesInOrder) {
  FrameWriter writer(folder_.path());
  for (int i = 0; i < kFrames; ++i) {
    State state = frame(i);
    writer.write(i, state);
    state.values().setZero();  // the writer has copied the state
  }
  writer.finish();
  for (int i = 0; i < kFrames; ++i)
    EXPECT_EQ(readFile(folder_.path(frameName(i))), textOfFrame(frame(i)));
  EXPECT_GT(writer.seconds(), 0.0);
}

// A frame can't be renamed to its name, as a folder is in its way.
TEST_P(FrameWriterThread, FailedFrameIsNamedAndNothingIsWrittenAfterIt) {
  for (const int failed : {2, kFrames - 1}) {
    const TemporaryFolder folder;
    Scenario scenario;
    scenario.output = folder.path();
    scenario.frames = kFrames;
    spring_pendulum::Run run({Eigen::VectorXd::Ones(GetParam()), frame(1)}, scenario);
    RunFiles files(run, scenario);
    std::filesystem::create_directory(folder.path(frameName(failed)));
    std::string message;
    try {
      while (run.advance()) files.write(run);  // the last frame also finishes the files
    } catch (const FileError& error) {
      message = error.what();
    }
    EXPECT_THROW(files.finish(), FileError);
    EXPECT_THROW(files.write(run), FileError);
    EXPECT_THAT(message, testing::HasSubstr(folder.path(frameName(failed))));
    for (const int other : {failed - 1, failed + 1})
      EXPECT_EQ(std::filesystem::exists(folder.path(frameName(other))), other < failed);
  }
}

INSTANTIATE_TEST_SUITE_P(SmallAndLarge, FrameWriterThread, testing::Values(3, 2000));

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
  const Scene particles = readParticleFile(folder.write("p.txt", "0.5 0 1\n1234.25 0.5 1\n"));
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

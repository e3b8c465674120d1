// Bad input: a message of one line, the exit status, and nothing written or removed.
#include <spring_pendulum/integration/method_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <ostream>
#include <sys/stat.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct BadInput {
  std::string name;
  std::vector<std::string> options;
  int status;
  std::string message;  ///< how it starts
};

std::ostream& operator<<(std::ostream& stream, const BadInput& input) {
  return stream << input.name;
}

/// A folder with what the options below refer to, and a frame of an earlier run.
void fill(const TemporaryFolder& folder) {
  folder.write("particle.txt", kTwoParticles);
  folder.write("frame_0007.txt", "earlier\n");
  folder.write("same_place.txt", "0 0 1\n0 0 1\n");
  folder.write("secret.txt", kTwoParticles);
  folder.write("secret.yaml", "frames: 5\n");
  folder.write("unknown.yaml", "# comment\nframes: 5\nframse: 6\n");
  folder.write("value.yaml", "time_step: -1\n");
  folder.write("frames.yaml", "frames: 5\n");
  folder.write("method.yaml", "method: Oiler\n");
  std::filesystem::create_directory(folder.path("folder"));
  chmod(folder.path("secret.txt").c_str(), 0);
  chmod(folder.path("secret.yaml").c_str(), 0);
  mkfifo(folder.path("pipe").c_str(), 0600);
}

class Exercise3Refuses : public testing::TestWithParam<BadInput> {};

TEST_P(Exercise3Refuses, InOneLineAndTouchesNothing) {
  const TemporaryFolder folder;
  fill(folder);
  const std::vector<std::string> before = listFolder(folder.path());
  Command command = exercise3(folder, GetParam().options);
  command.prepare = respectPermissions;
  const Result result = run(command);
  EXPECT_EQ(result.status, GetParam().status);
  EXPECT_EQ(result.output, "");
  const std::string& message = GetParam().message;
  const bool has_whole_path = GetParam().status == 1 && message.front() != '/';
  EXPECT_THAT(result.errors, StartsWith(has_whole_path ? folder.path(message) : message));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_EQ(result.errors.back(), '\n');
  EXPECT_EQ(listFolder(folder.path()), before);
  EXPECT_EQ(readFile(folder.path("frame_0007.txt")), "earlier\n");
}

BadInput particles(const std::string& name, const std::string& file, int status,
                   const std::string& message) {
  return {name, {"Euler", "--particles", file}, status, file + message};
}

BadInput value(const std::string& name, const std::string& option, const std::string& text,
               const std::string& right) {
  return {
      name, {"Euler", option, text}, 2, option + ": must be " + right + ", got '" + text + "'\n"};
}

std::string nameOf(const testing::TestParamInfo<BadInput>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Particles, Exercise3Refuses,
    testing::Values(
        particles("NoFile", "none.txt", 1, ": could not be read: No such file or directory\n"),
        particles("AFolder", "folder", 1, ": could not be read: it is a folder"),
        particles("APipe", "pipe", 1, ": could not be read: it is a pipe or a device"),
        particles("ADevice", "/dev/zero", 1, ": could not be read: it is a pipe or a device"),
        particles("Unreadable", "secret.txt", 1, ": could not be read: Permission denied\n"),
        particles("SamePlace", "same_place.txt", 2, ":2: same position as the particle in line 1")),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    Options, Exercise3Refuses,
    testing::Values(
        BadInput{"NoMethod", {}, 2, "METHOD is missing; try: Exercise3 Runge-Kutta-4 "},
        BadInput{"UnknownMethod",
                 {"Oiler"},
                 2,
                 "METHOD: unknown method 'Oiler'; did you mean 'Euler'? Known methods: Euler, "
                 "Runge-Kutta-2, "},
        BadInput{"MethodOfAnotherProgram",
                 {"DOP853"},
                 2,
                 "METHOD: unknown method 'DOP853'; did you mean 'Taylor-8'? "},
        BadInput{"TwoMethods", {"Euler", "euler"}, 2, "'euler': give only one METHOD\n"},
        BadInput{"MethodSecond",
                 {"a.txt", "auto"},
                 2,
                 "'auto': METHOD comes first: Exercise3 auto a.txt\n"},
        BadInput{"OptionOfRos", {"Euler", "_frames:=5"}, 2, "'_frames:=5': write --frames 5\n"},
        BadInput{"OptionWithoutDashes",
                 {"Euler", "a.txt", "time_step=0.1"},
                 2,
                 "'time_step=0.1': write --time-step 0.1\n"},
        BadInput{"OptionAsValue",
                 {"Euler", "--output", "--no-frames"},
                 2,
                 "--output: needs a value, see --help\n"},
        BadInput{"TwoFiles", {"Euler", "a", "b"}, 2, "'b': give only one particle file\n"},
        BadInput{"AFileTwice", {"Euler", "a", "-p", "b"}, 2, "'a': give only one particle file\n"},
        BadInput{"UnknownOption",
                 {"Euler", "--frame", "5"},
                 2,
                 "unknown option '--frame'; did you mean '--frames'? Known options: --config, "
                 "--particles, "},
        BadInput{"TwoLinesInAnOption",
                 {"Euler", "--no\nway"},
                 2,
                 "unknown option '--no?way'; known options: "},
        BadInput{
            "Twice", {"Euler", "--frames", "4", "--frames", "5"}, 2, "--frames: is given twice\n"},
        BadInput{"NoValue", {"Euler", "--frames"}, 2, "--frames: needs a value, see --help\n"},
        BadInput{"NothingAfterTheEqualsSign",
                 {"Euler", "--output="},
                 2,
                 "--output: needs a value, see --help\n"},
        value("NoOutput", "--output", "", "a folder"),
        value("NoParticles", "--particles", "", "a file"),
        BadInput{"NoConfig", {"Euler", "--config", ""}, 2, "--config: must be a file, got ''"},
        value("NegativeTimeStep", "--time-step", "-0.01", "a number above 0 s"),
        value("ZeroTimeStep", "--time-step", "0", "a number above 0 s"),
        value("InfiniteTimeStep", "--time-step", "inf", "a number above 0 s"),
        BadInput{"DecimalComma",
                 {"Euler", "--time-step", "0,01"},
                 2,
                 "--time-step: '0,01' is not a number; use a decimal point\n"},
        value("NegativeFrames", "--frames", "-1", "a whole number of at least 1"),
        value("NoFrames", "--frames", "0", "a whole number of at least 1"),
        value("BrokenFrames", "--frames", "5.5", "a whole number of at least 1"),
        value("NoSteps", "--steps-per-frame", "0", "a whole number of at least 1"),
        value("NegativeStiffness", "--stiffness", "-1", "a number of at least 0 N/m"),
        value("NanDamping", "--damping", "nan", "a number of at least 0 N·s/m"),
        value("NoRestLength", "--rest-length", "long", "a number of at least 0 m"),
        BadInput{"FlagWithValue",
                 {"Euler", "--no-frames=1"},
                 2,
                 "--no-frames: takes no value, see --help\n"},
        BadInput{
            "UnknownOptionWithoutValue", {"Euler", "--framse="}, 2, "unknown option '--framse'"},
        BadInput{
            "NamelessOption", {"Euler", "--=", "--=3"}, 2, "unknown option ''; known options: "},
        BadInput{"ValueOfASwitchMissing",
                 {"Euler", "--no-frames="},
                 2,
                 "--no-frames: takes no value, see --help\n"},
        BadInput{"MoreStepsThanCounted",
                 {"Euler", "--frames", "9223372036854775807", "--steps-per-frame", "2"},
                 2,
                 "frames times steps_per_frame must be at most 9223372036854775807, got "},
        BadInput{"EndlessRun",
                 {"Euler", "--time-step", "1e308"},
                 2,
                 "frames times steps_per_frame times time_step must be finite, got 500 times 10 "
                 "times 1e+308 s\n"},
        value("EndlessFrames", "--frame-interval", "1e9", "a number from 1e-300 to 1e+06 s"),
        BadInput{"TinyTolerance",
                 {"Taylor-8", "--tolerance", "1e-300"},
                 2,
                 "tolerance: must be at least 2.3e-13 m for this scene, because of the rounding "},
        BadInput{"RestWithoutStiffness",
                 {"Euler", "--start", "at_rest", "--stiffness", "0"},
                 2,
                 "a chain at rest needs a stiffness above 0 N/m"},
        BadInput{"RestWithoutLength",
                 {"Auto", "--start", "at_rest", "--rest-length", "0", "--gravity", "0"},
                 2,
                 "a chain at rest with a spring of length 0"},
        BadInput{"RestAndResume",
                 {"Euler", "--resume", "--start", "at_rest"},
                 2,
                 "start: at_rest and resume exclude each other"},
        value("InfiniteGravity", "--gravity", "-1e999", "a finite number in m/s²")),
    nameOf);

INSTANTIATE_TEST_SUITE_P(
    Config, Exercise3Refuses,
    testing::Values(
        BadInput{"NoFile",
                 {"Euler", "--config", "none.yaml"},
                 1,
                 "none.yaml: could not be read: No such file"},
        BadInput{"AFolder", {"Euler", "--config", "folder"}, 1, "folder: could not be read: "},
        BadInput{"Unreadable",
                 {"Euler", "--config", "secret.yaml"},
                 1,
                 "secret.yaml: could not be read: Permission denied\n"},
        BadInput{"UnknownKey",
                 {"Euler", "--config", "unknown.yaml"},
                 2,
                 "unknown.yaml:3: unknown parameter 'framse'; did you mean 'frames'? Known "
                 "parameters: method, "},
        BadInput{"Value",
                 {"Euler", "--config", "value.yaml"},
                 2,
                 "value.yaml:1: time_step: must be a number above 0 s, got '-1'\n"},
        BadInput{"UnknownMethod",
                 {"--config", "method.yaml"},
                 2,
                 "method.yaml:1: method: unknown method 'Oiler'; did you mean 'Euler'? "},
        BadInput{"NoMethod", {"--config", "frames.yaml"}, 2, "METHOD is missing; try: "}),
    nameOf);

std::vector<BadInput> meaningless() {
  std::vector<BadInput> rows;
  for (const Method& method : methodTable()) {
    const bool fixed = method.hasFixedStep();
    const std::vector<std::string> options =
        fixed ? std::vector<std::string>{"--tolerance", "--frame-interval"}
              : std::vector<std::string>{"--time-step", "--steps-per-frame"};
    for (const std::string& option : options) {
      std::string name = std::string(method.name) + option;
      name.erase(
          std::remove_if(name.begin(), name.end(),
                         [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }),
          name.end());
      rows.push_back({name, {std::string(method.name), option, "1"}, 2, option + ": "});
      rows.back().message += std::string(method.name) + (fixed ? " takes " : " chooses ");
    }
  }
  return rows;
}

INSTANTIATE_TEST_SUITE_P(Meaningless, Exercise3Refuses, testing::ValuesIn(meaningless()), nameOf);

TEST(Exercise3, CommandLineWinsOverTheFile) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  folder.write("run.yaml", "method: Euler\nframes: 5\nno_frames: true\n");
  const Result from_file = run(exercise3(folder, {"--config", "run.yaml"}));
  EXPECT_EQ(from_file.status, 0) << from_file.errors;
  EXPECT_THAT(from_file.output, StartsWith("Euler: 2 particles, 5 frames, 40 steps, "));
  EXPECT_THAT(from_file.output, testing::Not(HasSubstr("writing")));
  const Result result =
      run(exercise3(folder, {"--config", "run.yaml", "Runge-Kutta-2", "--frames", "7"}));
  EXPECT_THAT(result.output, StartsWith("Runge-Kutta-2: 2 particles, 7 frames, 60 steps, "));
  EXPECT_THAT(listFolder(folder.path()), testing::ElementsAre("particle.txt", "run.yaml"));
}

TEST(Exercise3, NamesTheOptionIfTheDefaultParticleFileIsMissing) {
  const TemporaryFolder folder;
  const Result result = run(exercise3(folder, {"Euler"}));
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, folder.path("particle.txt") +
                               ": no such file; give a particle file with --particles\n");
  EXPECT_TRUE(listFolder(folder.path()).empty());
}

TEST(Exercise3, TwoDashesEndTheOptions) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  EXPECT_EQ(run(exercise3(folder, {"--no-frames", "--", "Euler"})).status, 0);
}

TEST(Exercise3, AnswersWithoutARun) {
  const TemporaryFolder folder;
  const Result help = run(exercise3(folder, {"--help"}));
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.output, HasSubstr("--steps-per-frame N"));
  const Result version = run(exercise3(folder, {"--version"}));
  EXPECT_EQ(version.status, 0);
  EXPECT_THAT(version.output, StartsWith("spring_pendulum "));
  const Result methods = run(exercise3(folder, {"--list-methods"}));
  EXPECT_EQ(methods.status, 0);
  for (const Method& method : methodTable()) {
    EXPECT_THAT(methods.output, HasSubstr(std::string(method.name) + " "));
  }
  EXPECT_EQ(help.errors + version.errors + methods.errors, "");
}

TEST(Exercise3, TellsWhenItsOutputIsLost) {
  const TemporaryFolder folder;
  const Result result = run({{"/bin/sh", "-c", EXERCISE3 " --help > /dev/full"}, folder.path()});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(result.errors, "standard output: could not be written: No space left on device\n");
}

TEST(Exercise3, UnderstandsWhatEverybodyTypes) {
  const TemporaryFolder folder;
  folder.write("mine.txt", kTwoParticles);
  const Result expected = run(exercise3(
      folder, {"Runge-Kutta-4", "--particles", "mine.txt", "--frames", "3", "--output", "a"}));
  EXPECT_EQ(expected.status, 0) << expected.errors;
  const std::vector<std::vector<std::string>> commands{
      {"Runge-Kutta-4", "mine.txt", "--output", "b"},
      {"runge-kutta-4", "-p", "mine.txt", "-o", "b"},
      {"-ob", "RUNGE_KUTTA_4", "-pmine.txt"}};
  for (std::vector<std::string> command : commands) {
    command.insert(command.end(), {"--frames", "3"});
    const Result result = run(exercise3(folder, command));
    EXPECT_EQ(result.errors, "");
    EXPECT_EQ(readFile(folder.path("b/frame_0002.txt")), readFile(folder.path("a/frame_0002.txt")));
    std::filesystem::remove_all(folder.path("b"));
  }
  EXPECT_EQ(run(exercise3(folder, {"-h"})).output, run(exercise3(folder, {"--help"})).output);
}

TEST(Exercise3, RemarksThatTheChainFallsUpwards) {
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  const Result result = run(
      exercise3(folder, {"Runge-Kutta-4", "--no-frames", "--frames", "3", "--gravity", "-9.81"}));
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "gravity of -9.81 m/s² points up: the chain falls upwards\n");
}

}  // namespace
}  // namespace spring_pendulum

// Bad input: a message of one line, the exit status, and nothing written or removed.
#include <spring_pendulum/integration/method_table.hpp>

#include <filesystem>
#include <sys/stat.h>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

struct BadInput {
  std::string options;  ///< after the program, see wordsOf
  int status;
  std::string message;  ///< how it starts; a path is that of a file in the folder
};

class Exercise3Refuses : public Exercise3Test {
 protected:
  /// A folder with what the options below refer to, and a frame of an earlier run.
  Exercise3Refuses() {
    folder_.write("frame_0007.txt", "earlier\n");
    folder_.write("same_place.txt", "0 0 1\n0 0 1\n");
    folder_.write("secret.txt", kTwoParticles);
    folder_.write("unknown.yaml", "# comment\nframes: 5\nframse: 6\n");
    folder_.write("value.yaml", "time_step: -1\n");
    folder_.write("frames.yaml", "frames: 5\n");
    folder_.write("method.yaml", "method: Oiler\n");
    std::filesystem::create_directory(path("folder"));
    chmod(path("secret.txt").c_str(), 0);
    mkfifo(path("pipe").c_str(), 0600);
  }

  void expectOneLineForEach(const std::vector<BadInput>& rows) const {
    const std::vector<std::string> before = list();
    for (const auto& [options, status, message] : rows) {
      SCOPED_TRACE(options);
      Command refused = command(options);
      refused.prepare = respectPermissions;
      const Result result = run(refused);
      EXPECT_EQ(result.status, status);
      EXPECT_EQ(result.output, "");
      const bool has_whole_path = status == 1 && message.front() != '/';
      EXPECT_THAT(result.errors, StartsWith(has_whole_path ? path(message) : message));
      expectOneLine(result.errors);
      EXPECT_EQ(list(), before);
      EXPECT_EQ(read("frame_0007.txt"), "earlier\n");
    }
  }
};

TEST_F(Exercise3Refuses, Files) {
  expectOneLineForEach({
      {"Euler none.txt", 1, "none.txt: could not be read: No such file or directory\n"},
      {"Euler folder", 1, "folder: could not be read: it is a folder"},
      {"Euler pipe", 1, "pipe: could not be read: it is a pipe or a device"},
      {"Euler /dev/zero", 1, "/dev/zero: could not be read: it is a pipe or a device"},
      {"Euler secret.txt", 1, "secret.txt: could not be read: Permission denied\n"},
      {"Euler same_place.txt", 2, "same_place.txt:2: same position as the particle in line 1"},
      {"Euler --config none.yaml", 1, "none.yaml: could not be read: No such file"},
      {"Euler --config unknown.yaml", 2,
       "unknown.yaml:3: unknown parameter 'framse'; did you mean 'frames'? Known parameters: "},
      {"Euler --config value.yaml", 2,
       "value.yaml:1: time_step: must be a number above 0 s, got '-1'\n"},
      {"--config method.yaml", 2,
       "method.yaml:1: method: unknown method 'Oiler'; did you mean 'Euler'? "},
      {"--config frames.yaml", 2, "METHOD is missing; try: "},
  });
}

TEST_F(Exercise3Refuses, Words) {
  expectOneLineForEach({
      {"", 2, "METHOD is missing; try: Exercise3 Runge-Kutta-4 "},
      {"Oiler", 2, "METHOD: unknown method 'Oiler'; did you mean 'Euler'? Known methods: Euler, "},
      {"DOP853", 2, "METHOD: unknown method 'DOP853'; did you mean 'Taylor-8'? "},
      {"Euler euler", 2, "'euler': give only one METHOD\n"},
      {"a.txt auto", 2, "'auto': METHOD comes first: Exercise3 auto a.txt\n"},
      {"Euler _frames:=5", 2, "'_frames:=5': write --frames 5\n"},
      {"Euler a.txt time_step=0.1", 2, "'time_step=0.1': write --time-step 0.1\n"},
      {"Euler a b", 2, "'b': give only one particle file\n"},
      {"Euler a -p b", 2, "'a': give only one particle file\n"},
      {"Euler --frame 5", 2,
       "unknown option '--frame'; did you mean '--frames'? Known options: --config, --particles, "},
      {"Euler --no\nway", 2, "unknown option '--no?way'; known options: "},
      {"Euler --framse=", 2, "unknown option '--framse'"},
      {"Euler --= --=3", 2, "unknown option ''; known options: "},
      {"Euler --frames 4 --frames 5", 2, "--frames: is given twice\n"},
      {"Euler --frames", 2, "--frames: needs a value, see --help\n"},
      {"Euler --output=", 2, "--output: needs a value, see --help\n"},
      {"Euler --output --no-frames", 2, "--output: needs a value, see --help\n"},
      {"Euler --no-frames=1", 2, "--no-frames: takes no value, see --help\n"},
      {"Euler --no-frames=", 2, "--no-frames: takes no value, see --help\n"},
  });
}

TEST_F(Exercise3Refuses, Values) {
  const std::string time_step = "--time-step: must be a number above 0 s, got ";
  const std::string frames = "--frames: must be a whole number of at least 1, got ";
  expectOneLineForEach({
      {"Euler --output ''", 2, "--output: must be a folder, got ''\n"},
      {"Euler --particles ''", 2, "--particles: must be a file, got ''\n"},
      {"Euler --config ''", 2, "--config: must be a file, got ''\n"},
      {"Euler --time-step -0.01", 2, time_step + "'-0.01'\n"},
      {"Euler --time-step 0", 2, time_step + "'0'\n"},
      {"Euler --time-step inf", 2, time_step + "'inf'\n"},
      {"Euler --time-step 0,01", 2, "--time-step: '0,01' is not a number; use a decimal point\n"},
      {"Euler --frames -1", 2, frames + "'-1'\n"},
      {"Euler --frames 0", 2, frames + "'0'\n"},
      {"Euler --frames 5.5", 2, frames + "'5.5'\n"},
      {"Euler --damping nan", 2, "--damping: must be a number of at least 0 N·s/m, got 'nan'\n"},
      {"Euler --rest-length long", 2,
       "--rest-length: must be a number of at least 0 m, got 'long'"},
      {"Euler --gravity -1e999", 2, "--gravity: must be a finite number in m/s², got '-1e999'\n"},
      {"Euler --frame-interval 1e9", 2,
       "--frame-interval: must be a number from 1e-300 to 1e+06 s, got '1e9'\n"},
      {"Euler --frames 9223372036854775807 --steps-per-frame 2", 2,
       "frames times steps_per_frame must be at most 9223372036854775807, got "},
      {"Euler --time-step 1e308", 2,
       "frames times steps_per_frame times time_step must be finite, got 500 times 10 times "
       "1e+308 s\n"},
      {"Taylor-8 --tolerance 1e-300", 2,
       "tolerance: must be at least 2.3e-13 m for this scene, because of the rounding "},
      {"Euler --start at_rest --stiffness 0", 2, "a chain at rest needs a stiffness above 0 N/m"},
      {"Auto --start at_rest --rest-length 0 --gravity 0", 2,
       "a chain at rest with a spring of length 0"},
      {"Euler --resume --start at_rest", 2, "start: at_rest and resume exclude each other"},
  });
}

TEST_F(Exercise3Refuses, OptionsThatAMethodDoesNotUse) {
  for (const Method& method : methodTable()) {
    const bool fixed = method.hasFixedStep();
    const std::string option = fixed ? "--tolerance" : "--time-step";
    const std::string other = fixed ? "--frame-interval" : "--steps-per-frame";
    const std::string why = ": " + method.name + (fixed ? " takes " : " chooses ");
    expectOneLineForEach({{method.name + " " + option + " 1", 2, option + why},
                          {method.name + " " + other + " 1", 2, other + why}});
  }
}

class Exercise3Input : public Exercise3Test {};

TEST_F(Exercise3Input, CommandLineWinsOverTheFile) {
  folder_.write("run.yaml", "method: Euler\nframes: 5\nno_frames: true\n");
  folder_.write("frame_0000.txt", "earlier\n");
  const Result from_file = runWith("--config run.yaml");
  EXPECT_EQ(from_file.status, 0) << from_file.errors;
  EXPECT_THAT(from_file.output, StartsWith("Euler: 2 particles, 5 frames, 40 steps, "));
  EXPECT_THAT(from_file.output, testing::Not(HasSubstr("writing")));
  EXPECT_THAT(runWith("--config run.yaml Runge-Kutta-2 --frames 7").output,
              StartsWith("Runge-Kutta-2: 2 particles, 7 frames, 60 steps, "));
  EXPECT_THAT(list(), testing::ElementsAre("frame_0000.txt", "particle.txt", "run.yaml"));
  EXPECT_EQ(read("frame_0000.txt"), "earlier\n");
}

TEST_F(Exercise3Input, NamesTheOptionIfTheDefaultParticleFileIsMissing) {
  std::filesystem::remove(path("particle.txt"));
  const Result result = runWith("Euler");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("no such file; give a particle file with --particles\n"));
  EXPECT_TRUE(list().empty());
}

TEST_F(Exercise3Input, AnswersWithoutARun) {
  const Result help = runWith("--help");
  EXPECT_THAT(help.output, HasSubstr("--steps-per-frame N"));
  EXPECT_EQ(runWith("-h").output, help.output);
  const Result version = runWith("--version");
  EXPECT_THAT(version.output, StartsWith("spring_pendulum "));
  const Result methods = runWith("--list-methods");
  for (const Method& method : methodTable())
    EXPECT_THAT(methods.output, HasSubstr(method.name + " "));
  EXPECT_EQ(help.errors + version.errors + methods.errors, "");
  EXPECT_EQ(help.status + version.status + methods.status, 0);
}

TEST_F(Exercise3Input, UnderstandsWhatEverybodyTypes) {
  folder_.write("mine.txt", kTwoParticles);
  const Result expected = runWith("Runge-Kutta-4 --particles mine.txt --frames 3 --output a");
  EXPECT_EQ(expected.status, 0) << expected.errors;
  for (const std::string options :
       {"Runge-Kutta-4 mine.txt --output b --frames 3", "runge-kutta-4 -p mine.txt -o b --frames=3",
        "-ob RUNGE_KUTTA_4 -pmine.txt --frames 3", "-o b --frames 3 -- rk4 mine.txt"}) {
    EXPECT_EQ(runWith(options).errors, "") << options;
    EXPECT_EQ(read("b/frame_0002.txt"), read("a/frame_0002.txt")) << options;
    std::filesystem::remove_all(path("b"));
  }
}

TEST_F(Exercise3Input, RemarksThatTheChainFallsUpwards) {
  const Result result = runWith("Runge-Kutta-4 --no-frames --frames 3 --gravity -9.81");
  EXPECT_EQ(result.status, 0);
  EXPECT_EQ(result.errors, "gravity of -9.81 m/s² points up: the chain falls upwards\n");
}

}  // namespace
}  // namespace spring_pendulum

// No file of a run has two uses: every output option of every program, pointed at every input and at the
// other outputs. All inputs stay byte for byte the same, and a run that is refused touches nothing.
#include <fcntl.h>
#include <filesystem>
#include <map>
#include <string>
#include <unistd.h>
#include <vector>

#include "process/exercise3.hpp"

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "> ";
constexpr const char* kStandardError = "2> ";
constexpr int kNoRedirection = 126;

/// Where an input may lie: plain, like a frame, a hidden file, or an output whose name follows from another.
const std::vector<std::string> kPlaces{
    "e",     "o/frame_0001.txt", "o/.frame_0001.txt.tmp", "o/.frames.tmp", "o/case_0.txt", ".e.tmp",
    "e.png", "e.csv.journal"};
/// Values of an output option: these places, links to the input, and folders.
const std::vector<std::string> kValues{
    "e",     "o/frame_0001.txt",     "o/.frame_0001.txt.tmp", "soft", "hard", "o", "e/inside",
    "e.csv", "o/../o/frame_0009.txt"};

struct Program {
  std::vector<std::string> command;
  std::map<std::string, std::string> inputs;  ///< text by the name in command or in another input
  std::vector<std::string> outputs;           ///< options
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class TouchedFiles : public testing::Test {
 protected:
  /// Runs a program with one input at another place and values for some output options.
  void check(const Program& program, const std::string& input, const std::string& place,
             const Files& outputs) {
    const TemporaryFolder folder;
    fs::create_directories(folder.path("o"));
    folder.write("o/frame_0009.txt", "earlier\n");
    Files inputs;
    for (const auto& [name, text] : program.inputs) {
      const std::string path = name == input ? place : name;
      inputs[path] = replaced(text, input, place);
      folder.write(path, inputs[path]);
    }
    fs::create_symlink(place, folder.path("soft"));
    fs::create_hard_link(folder.path(place), folder.path("hard"));
    const Files before = filesIn(folder.path());
    Command command{{}, folder.path(), {}, {}};
    for (const std::string& word : program.command)
      command.arguments.push_back(word == input ? place : word);
    for (const auto& [option, value] : outputs) {
      if (option == kStandardOutput || option == kStandardError) {
        command.prepare = [file = value, to = option == kStandardOutput ? 1 : 2] {
          const int stream = open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
          if (stream < 0 || dup2(stream, to) < 0) _exit(kNoRedirection);
        };
      } else {
        command.arguments.insert(command.arguments.end(), {option, value});
      }
    }
    SCOPED_TRACE(testing::PrintToString(command.arguments) + testing::PrintToString(outputs));
    const Result result = run(command);
    if (result.status == kNoRedirection) return;
    SCOPED_TRACE(result.errors);
    EXPECT_LE(result.status, 2);
    ++(result.status == 0 ? accepted_ : refused_);
    Files after = filesIn(folder.path());
    for (const auto& [path, text] : result.status == 0 ? inputs : before)
      EXPECT_EQ(after[path], text) << path;
    if (result.status == 0) expectOutputs(folder, outputs);
  }

  /// Checks that a run that has ended well wrote what it was asked for.
  static void expectOutputs(const TemporaryFolder& folder, const Files& outputs) {
    const std::map<std::string, const char*> begin{{"--energy", "frame,time"},
                                                   {"--bag", "#ROSBAG"},
                                                   {"--save-state", "# state of"},
                                                   {kStandardOutput, ": 2 "}};
    for (const auto& [option, value] : outputs) {
      const auto expected = begin.find(option);
      if (expected == begin.end()) continue;
      EXPECT_THAT(readFile(folder.path(value)), testing::HasSubstr(expected->second)) << option;
    }
  }

  /// Runs the program with one of `every` combinations.
  void checkAgainstInputs(const Program& program, int every = 1) {
    int count = 0;
    for (const auto& [input, text] : program.inputs)
      for (const std::string& place : kPlaces)
        for (const std::string& option : program.outputs)
          for (const std::string& value : kValues)
            if (count++ % every == 0) check(program, input, place, {{option, value}});
  }

  void expectBoth(int least) const {
    EXPECT_GT(accepted_, least);
    EXPECT_GT(refused_, least);
  }

  int accepted_ = 0, refused_ = 0;
};

const Program kExercise3{{EXERCISE3, "Euler", "--particles", "in.txt", "--config", "run.yaml"},
                         {{"in.txt", kTwoParticles}, {"run.yaml", "frames: 3\n"}},
                         {"--energy", "--save-state", "--output", kStandardOutput}};

TEST_F(TouchedFiles, OfExercise3AreNoInputs) {
  checkAgainstInputs(kExercise3);
  for (const char* value : {"e", "soft", "hard"})
    check(kExercise3, "in.txt", "e", {{kStandardError, value}});
  const std::string state = "# state of 2 particles at frame 0, t = 0 s\n0 0 1 0 0\n1 0 1 0 0\n";
  checkAgainstInputs({{EXERCISE3, "Euler", "in.txt", "--resume", "--frames", "3"},
                      {{"in.txt", state}},
                      {"--energy", "--save-state", "--output"}});
  expectBoth(100);
}

TEST_F(TouchedFiles, OfExercise3HaveOneUse) {
  for (const std::string& first : kExercise3.outputs)
    for (const std::string& second : kExercise3.outputs) {
      if (second <= first) continue;
      for (const std::string& value : kValues)
        for (const std::string& other : kValues)
          check(kExercise3, "in.txt", "e.png", {{first, value}, {second, other}});
    }
  expectBoth(50);
}

TEST_F(TouchedFiles, OfSweepAreNoInputs) {
  const std::string study =
      "base: {method: Euler, particles: in.txt, frames: 2}\naxes: {mass_factor: [1, 2]}\n"
      "plot: {type: lines, x: mass_factor, y: position_error}\n";
  const std::map<std::string, std::string> inputs{{"in.txt", kTwoParticles}, {"study.yaml", study}};
  checkAgainstInputs({{SWEEP, "study.yaml"}, inputs, {"--output", kStandardOutput}});
  checkAgainstInputs({{SWEEP, "study.yaml", "--case", "0"}, inputs, {"--output"}});
  for (const char* place : {"e.png", "e.csv", ".e.png.1.tmp", "e.png.unfinished"})
    check({{SWEEP, "study.yaml", "--plot", "--shard", "1/1"}, inputs, {}}, "in.txt", place,
          {{"--output", "e.csv"}});
  expectBoth(50);
}

#ifdef RECORD_BAG
TEST_F(TouchedFiles, OfRecordBagAreNoInputs) {
  Program program = kExercise3;
  program.command[0] = RECORD_BAG;
  program.outputs = {"--bag"};
  constexpr int kEvery = 4;  // This program starts slowly.
  checkAgainstInputs(program, kEvery);
  const TemporaryFolder folder;
  const std::string bag = folder.path("inputs.bag");
  ASSERT_EQ(
      run({{RECORD_BAG, "Euler", folder.write("in.txt", kTwoParticles), "--bag", bag}}).status, 0);
  // The bag has no inputs, so the program ends with status 2; without the check, it would be replaced first.
  checkAgainstInputs({{RECORD_BAG, "--inputs", "in.bag"},
                      {{"in.bag", readFile(bag)}},
                      {"--bag", "--output", "--energy", "--save-state"}},
                     kEvery);
  expectBoth(5);
}
#endif

/// A name in an error message neither forges a line nor controls the terminal.
TEST(StrangeNames, MakeOneLineInEveryProgram) {
  const std::vector<std::vector<std::string>> programs{
      {EXERCISE3, "Euler", "--no-frames", "--particles"},
      {EXERCISE3, "Euler", "--no-frames", "--config"},
      {EXERCISE3, "Euler", "--no-frames", "--energy"},
      {SWEEP},
      {CHECK_FRAMES},
      {CHECK_FRAMES, "o", "--tableau"},
#ifdef RECORD_BAG
      {RECORD_BAG, "--inputs"},
      {RECORD_BAG, "Euler", "--bag"},
#endif
  };
  const TemporaryFolder folder;
  folder.write("particle.txt", kTwoParticles);
  for (const std::string name : {" a b ", "a\nb\x1b[31m", "-dash", "\xff"}) {
    fs::create_directory(folder.path(name));  // where a file should be
    for (std::vector<std::string> arguments : programs) {
      arguments.push_back(name);
      const Result result = run({arguments, folder.path()});
      SCOPED_TRACE(testing::PrintToString(arguments) + result.errors);
      EXPECT_THAT(result.status, testing::AnyOf(1, 2));
      EXPECT_EQ(result.output, "");
      expectOneLine(result.errors);
      EXPECT_EQ(result.errors.find_first_of("\x1b\xff"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace spring_pendulum

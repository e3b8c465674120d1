// No file of a run has two uses: every name that a program touches against every other one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

constexpr const char* kConfiguration = "frames: 3\n";
constexpr int kNoRedirection = 126;

/// Names of files of a run, with their temporary names, links to them, and files as folders.
const std::vector<std::string> kNames{"e",
                                      "e.unfinished",
                                      "soft",
                                      "hard",
                                      "e/inside",
                                      "o",
                                      "o/frame_0001.txt",
                                      "o/.frame_0001.tmp",
                                      "o/../o/frame_0009.txt"};

/// The value of each option, and the file to which standard output is appended.
using Names = std::map<std::string, std::string>;

void prepareFolder(const TemporaryFolder& folder, const Names& names) {
  fs::create_directory(folder.path("o"));
  for (const char* earlier : {"e", "o/frame_0001.txt", "o/frame_0009.txt"}) {
    folder.write(earlier, "earlier\n");
  }
  fs::create_symlink("e", folder.path("soft"));
  fs::create_hard_link(folder.path("e"), folder.path("hard"));
  for (const char* input : {"--config", "--particles"}) {
    const std::string& name = names.at(input);
    const fs::path parent = fs::path(folder.path(name)).parent_path();
    if (fs::is_regular_file(parent)) fs::remove(parent);
    fs::create_directories(parent);
    folder.write(name, input[2] == 'c' ? kConfiguration : kTwoParticles);
  }
}

Result runWith(const std::string& program, const TemporaryFolder& folder, const Names& names) {
  Command command{{program, "Euler"}, folder.path(), {}, {}};
  for (const auto& [option, name] : names) {
    if (option.rfind("--", 0) == 0)
      command.arguments.insert(command.arguments.end(), {option, name});
  }
  command.prepare = [&names] {
    const auto name = names.find("stdout");
    if (name == names.end()) return;
    const int file = open(name->second.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    if (file < 0 || dup2(file, STDOUT_FILENO) < 0) _exit(kNoRedirection);
  };
  return run(command);
}

/// Checks that a run that has ended well wrote what it was asked for.
void expectOutputs(const TemporaryFolder& folder, const Names& names) {
  using testing::StartsWith;
  EXPECT_THAT(readFile(folder.path(names.at("--energy"))), StartsWith("frame,time"));
  const std::string frames = names.at("--output") + "/frame_000";
  for (const char* frame : {"0.txt", "1.txt", "2.txt"}) {
    EXPECT_THAT(readFile(folder.path(frames + frame)), StartsWith("0 0\n"));
  }
  if (names.count("--bag") > 0) {
    EXPECT_THAT(readFile(folder.path(names.at("--bag"))), StartsWith("#ROSBAG"));
  }
  if (names.count("stdout") > 0) {
    EXPECT_THAT(readFile(folder.path(names.at("stdout"))), testing::HasSubstr("verdict"));
  }
}

using Contents = std::map<std::string, std::string>;

Contents contentsOf(const TemporaryFolder& folder) {
  Contents contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path())) {
    if (entry.is_regular_file()) contents[entry.path().string()] = readFile(entry.path().string());
  }
  return contents;
}

class TouchedFiles : public testing::Test {
 protected:
  /// Runs a program in a new folder and checks that no file is lost.
  void check(const std::string& program, const Names& names) {
    const TemporaryFolder folder;
    try {
      prepareFolder(folder, names);
    } catch (const fs::filesystem_error&) {
      return;  // a file cannot lie in another file
    }
    const Contents before = contentsOf(folder);
    const std::string particles = folder.path(names.at("--particles"));
    const std::string config = folder.path(names.at("--config"));
    if (readFile(config) != kConfiguration || readFile(particles) != kTwoParticles) {
      return;  // both are the same file, or one is a folder
    }
    const Result result = runWith(program, folder, names);
    if (result.status == kNoRedirection) return;
    SCOPED_TRACE(result.errors);
    EXPECT_LE(result.status, 2);
    ++(result.status == 0 ? accepted_ : refused_);
    const Contents after = contentsOf(folder);
    EXPECT_EQ(readFile(particles), kTwoParticles);
    EXPECT_EQ(readFile(config), kConfiguration);
    if (result.status == 0) {
      expectOutputs(folder, names);
    } else {
      for (const auto& [path, text] : before) {
        EXPECT_TRUE(after.count(path) == 1 && after.at(path) == text) << path;
      }
    }
  }

  /// Gives two options, or standard output, each two of the names.
  void checkPair(const std::string& program, Names names, const std::string& first,
                 const std::string& second) {
    for (const std::string& first_name : kNames) {
      for (const std::string& second_name : kNames) {
        SCOPED_TRACE(first + " " + first_name + " " + second + " " + second_name);
        names[first] = first_name;
        names[second] = second_name;
        check(program, names);
      }
    }
  }

  int accepted_ = 0;
  int refused_ = 0;
};

const Names kDefaults{{"--particles", "particle.txt"},
                      {"--config", "run.yaml"},
                      {"--energy", "energy.csv"},
                      {"--output", "frames"}};

TEST_F(TouchedFiles, OfExercise3HaveOneUse) {
  const std::vector<std::string> roles{"--particles", "--config", "--energy", "--output", "stdout"};
  for (std::size_t i = 0; i < roles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) checkPair(EXERCISE3, kDefaults, roles[i], roles[j]);
  }
  EXPECT_GT(accepted_, 200);
  EXPECT_GT(refused_, 200);
}

#ifdef RECORD_BAG
TEST_F(TouchedFiles, OfRecordBagHaveOneUse) {
  Names defaults = kDefaults;
  defaults["--bag"] = "run.bag";
  for (const char* other : {"--particles", "--config", "--energy", "--output", "stdout"}) {
    checkPair(RECORD_BAG, defaults, "--bag", other);
  }
  EXPECT_GT(accepted_, 50);
  EXPECT_GT(refused_, 50);
}
#endif

}  // namespace
}  // namespace spring_pendulum

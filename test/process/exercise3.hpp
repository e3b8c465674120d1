// Exercise3 run as a program in a folder of its own.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace spring_pendulum {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

/// Two particles of 1 kg, a metre apart.
inline constexpr const char* kTwoParticles = "0 0 1\n1 0 1\n";

/// The file of a horizontal chain, a metre between neighbours.
inline std::string chainOf(int particles, const std::string& mass = "1") {
  std::string text;
  for (int i = 0; i < particles; ++i) text += std::to_string(i) + " 0 " + mass + "\n";
  return text;
}

inline Command exercise3(const TemporaryFolder& folder, const std::vector<std::string>& options) {
  Command command{{EXERCISE3}, folder.path(), {}, {}};
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  return command;
}

/// Text of each file in a folder and its subfolders, by its path in the folder.
using Files = std::map<std::string, std::string>;

inline Files filesIn(const std::string& folder) {
  Files files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    if (entry.is_regular_file()) files[path.lexically_relative(folder)] = readFile(path.string());
  }
  return files;
}

/// Splits a command line at blanks; '' is an empty word.
inline std::vector<std::string> wordsOf(const std::string& line) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  while ((begin = line.find_first_not_of(' ', begin)) != std::string::npos) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    if (words.back() == "''") words.back().clear();
    begin = end;
  }
  return words;
}

/// Runs with a fault at one of the calls on files in the folder. \returns its name; empty: too few calls
inline std::string disturb(Command command, int call, const std::string& kind, Result& result) {
  const TemporaryFolder outside;
  command.environment = {{"LD_PRELOAD", FAULT_INJECTION},
                         {"FAULT_FOLDER", command.folder},
                         {"FAULT_CALL", std::to_string(call)},
                         {"FAULT_KIND", kind},
                         {"FAULT_REPORT", outside.path("call")}};
  result = run(command);
  return readFile(outside.path("call"));
}

inline void expectOneLine(const std::string& text) {
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  EXPECT_EQ(text.back(), '\n');
}

/// A test in a folder with a particle file.
class Exercise3Test : public testing::Test {
 protected:
  explicit Exercise3Test(const std::string& particles = kTwoParticles) {
    folder_.write("particle.txt", particles);
  }

  Command command(const std::string& options) const { return exercise3(folder_, wordsOf(options)); }
  Result runWith(const std::string& options) const { return run(command(options)); }
  std::string read(const std::string& name) const { return readFile(folder_.path(name)); }
  std::string path(const std::string& name) const { return folder_.path(name); }
  std::vector<std::string> list(const std::string& name = ".") const {
    return listFolder(folder_.path(name));
  }

  TemporaryFolder folder_;
};

}  // namespace spring_pendulum

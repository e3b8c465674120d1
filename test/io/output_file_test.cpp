// Many runs write one file at the same time: each replaces it by a complete one or is refused.
#include "io/files/output_file.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

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
        for (int part = 0; part < 10; ++part) file.write(std::string(100, letter));
        file.finish();
        ++written;
      } catch (const FileError& error) {
        EXPECT_THAT(error.what(), testing::EndsWith("use a different path for each run"));
      }
      const std::string text = readFile(path);  // empty until the first run has finished
      EXPECT_TRUE(text == std::string(text.size(), text[0])) << text;
      EXPECT_TRUE(text.size() == 1000U || text.empty()) << text.size();
    }
  };
  std::vector<std::thread> runs;
  for (const char letter : {'a', 'b', 'c', 'd'}) runs.emplace_back(write, letter);
  for (std::thread& run : runs) run.join();
  EXPECT_GT(written, 0);
  EXPECT_EQ(listFolder(folder.path()), std::vector<std::string>{"e.csv"});
}

}  // namespace
}  // namespace spring_pendulum

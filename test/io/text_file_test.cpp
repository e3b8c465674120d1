#include "io/files/text_file.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

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

}  // namespace
}  // namespace spring_pendulum

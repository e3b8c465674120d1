#include "sweep/running/journal.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "support/temporary_folder.hpp"

namespace spring_pendulum::sweep {
namespace {

using Rows = std::map<std::int64_t, std::string>;

constexpr std::uint64_t kStudy = 0x1234;

/// Writes two cases. \returns the path of the journal
std::string writeJournal(const std::string& folder) {
  Journals journals(folder, kStudy);
  journals.start();
  journals.append(7, ",ok,0.25");
  journals.append(4711, ",not checked,nan");
  return folder + "/1.journal";
}

Rows rowsIn(const std::string& folder, std::uint64_t study = kStudy) {
  Rows rows;
  Journals(folder, study).read([&](std::int64_t index, std::string_view text) {
    rows[index] = text;
  });
  return rows;
}

TEST(Journals, KeepCasesOfAllProcesses) {
  const TemporaryFolder folder;
  EXPECT_TRUE(rowsIn(folder.path("absent")).empty());
  writeJournal(folder.path());
  Journals second(folder.path(), kStudy);
  second.start();
  second.append(8, ",diverged,1");
  EXPECT_EQ(rowsIn(folder.path()),
            (Rows{{7, ",ok,0.25"}, {8, ",diverged,1"}, {4711, ",not checked,nan"}}));
}

TEST(Journals, DropEveryTornEnd) {
  const TemporaryFolder folder;
  const std::string path = writeJournal(folder.path());
  const std::string whole = readFile(path);
  const std::size_t first_end = whole.find("\n4711") + 1;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    folder.write("1.journal", whole.substr(0, size));
    const Rows expected = size < first_end ? Rows{} : Rows{{7, ",ok,0.25"}};
    EXPECT_EQ(rowsIn(folder.path()), expected) << size;
  }
}

TEST(Journals, RefuseAnotherStudy) {
  const TemporaryFolder folder;
  writeJournal(folder.path());
  try {
    rowsIn(folder.path(), kStudy + 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("is the journal of another study or version"));
  }
}

TEST(Journals, AreRemovedWithTheirFolder) {
  const TemporaryFolder folder;
  const std::string path = folder.path("a/b");
  writeJournal(path);
  Journals(path, kStudy).remove();
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace spring_pendulum::sweep

#include "sweep/journal.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "support/temporary_folder.hpp"

namespace spring_pendulum::sweep {
namespace {

using Rows = std::map<std::int64_t, std::string>;

constexpr std::uint64_t kStudy = 0x1234;

class JournalOfTwoCases : public testing::Test {
 protected:
  JournalOfTwoCases() : path_(folder_.path("journal")) {
    Journal journal(path_, kStudy);
    journal.append(7, ",ok,0.25");
    journal.append(4711, ",not checked,nan");
  }

  static Rows rowsIn(const Journal& journal) {
    Rows rows;
    journal.read([&](std::int64_t index, std::string_view text) { rows[index] = text; });
    return rows;
  }

  TemporaryFolder folder_;
  std::string path_;
};

TEST_F(JournalOfTwoCases, KeepsCasesOfAllProcesses) {
  Journal first(path_, kStudy);
  Journal second(path_, kStudy);
  second.append(8, ",diverged,1");
  first.append(9, ",ok,2");
  EXPECT_EQ(rowsIn(first),
            (Rows{{7, ",ok,0.25"}, {8, ",diverged,1"}, {9, ",ok,2"}, {4711, ",not checked,nan"}}));
}

// Also if another process dies while this one works.
TEST_F(JournalOfTwoCases, DropsEveryTornEnd) {
  const std::string whole = readFile(path_);
  const std::size_t first_end = whole.find("\n4711") + 1;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    folder_.write("journal", whole.substr(0, size));
    Journal journal(path_, kStudy);
    const Rows expected = size < first_end ? Rows{} : Rows{{7, ",ok,0.25"}};
    EXPECT_EQ(rowsIn(journal), expected) << size;
    journal.append(4711, ",not checked,nan");
    folder_.write("journal", whole.substr(0, whole.size() - 5));
    journal.append(4711, ",not checked,nan");
    EXPECT_EQ(readFile(path_), whole) << size;
  }
}

TEST_F(JournalOfTwoCases, RefusesAnotherStudy) {
  try {
    const Journal other(path_, kStudy + 1);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("is the journal of another study or version"));
  }
}

TEST_F(JournalOfTwoCases, KnowsThatItWasRemoved) {
  Journal first(path_, kStudy);
  Journal second(path_, kStudy);
  EXPECT_TRUE(first.lock());
  first.remove();
  first.unlock();
  EXPECT_FALSE(second.lock());
}

}  // namespace
}  // namespace spring_pendulum::sweep

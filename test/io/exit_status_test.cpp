#include "io/program/exit_status.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>

namespace spring_pendulum {
namespace {

TEST(Failure, TellsBadInputFromAllElse) {
  EXPECT_EQ(failureOf(InputError("x must be 1")).status, kBadInput);
  EXPECT_EQ(failureOf(InputError("x must be 1")).message, "x must be 1");
  EXPECT_EQ(failureOf(FileError("disk full")).status, kFileFailed);
  EXPECT_EQ(failureOf(std::bad_alloc()).status, kFileFailed);
  EXPECT_THAT(failureOf(std::bad_alloc()).message, testing::HasSubstr("not enough memory"));
}

TEST(Failure, IsOneLineWhateverForeignTextIsInIt) {
  EXPECT_EQ(failureOf(InputError("no method 'a\nb\x1b[31m\x7f'")).message, "no method 'a?b?[31m?'");
}

}  // namespace
}  // namespace spring_pendulum

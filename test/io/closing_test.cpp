// What programs print at the end of a run.
#include "io/program/closing.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace spring_pendulum {
namespace {

TEST(Closing, TimesHaveThreeSignificantDigits) {
  const std::pair<double, const char*> rows[] = {
      {0.0, "0 ms"},          {4.2e-6, "0 ms"},   {4.2e-5, "0.04 ms"}, {1.2345e-3, "1.23 ms"},
      {0.0123456, "12.3 ms"}, {0.9994, "999 ms"}, {0.9996, "1 s"},     {1.2345, "1.23 s"},
      {59.96, "60 s"},        {99.96, "100 s"},   {1234.5, "1234 s"},
  };
  for (const auto& [seconds, text] : rows) EXPECT_EQ(durationText(seconds), text) << seconds;
}

}  // namespace
}  // namespace spring_pendulum

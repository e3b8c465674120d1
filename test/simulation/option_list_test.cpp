#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/option_list.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace spring_pendulum {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusalOf(const std::vector<std::pair<std::string, std::string>>& options) {
  try {
    makeScenario(options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OptionList, DescribesWhatMakeScenarioAccepts) {
  Scenario defaults;
  defaults.frames = 7;
  std::vector<std::pair<std::string, std::string>> given;
  for (const OptionDescription& option : describeOptions(defaults)) {
    EXPECT_FALSE(option.range.empty() || option.meaning.empty()) << option.key;
    if (option.users.empty() && option.key != "energy")
      given.emplace_back(option.key, option.value);
  }
  EXPECT_EQ(given.size(), 17U);
  EXPECT_EQ(makeScenario(given).frames, 7);
}

TEST(OptionList, LaterValuesOverrideEarlierOnes) {
  const Scenario scenario = makeScenario({{"frames", "3"}, {"damping", "0"}, {"frames", "4"}});
  EXPECT_EQ(scenario.frames, 4);
  EXPECT_EQ(scenario.damping, 0.0);
  EXPECT_EQ(makeScenario({}, scenario).frames, 4);
}

TEST(OptionList, RefusesWithOneLine) {
  EXPECT_EQ(refusalOf({{"time_step", "-1"}}), "time_step: must be a number above 0 s, got '-1'");
  EXPECT_THAT(refusalOf({{"time_stp", "1"}}),
              StartsWith("unknown option 'time_stp'; did you mean 'time_step'?"));
  EXPECT_EQ(refusalOf({{"method", "Auto"}, {"time_step", "0.1"}}),
            "time_step: Auto chooses its own steps; use tolerance and frame_interval");
  EXPECT_EQ(refusalOf({{"tolerance", "1"}}),
            "tolerance: Runge-Kutta-4 takes fixed steps; use time_step and steps_per_frame");
  EXPECT_THAT(refusalOf({{"frames", "9223372036854775807"}}), HasSubstr("must be at most"));
}

}  // namespace
}  // namespace spring_pendulum

// config/pendulum.yaml shows every parameter with its default.
#include "io/text_file.hpp"
#include "model/numbers.hpp"
#include <spring_pendulum/io/scenario_file.hpp>
#include <spring_pendulum/simulation/parameters.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>

namespace spring_pendulum {
namespace {

constexpr const char* kFile = PROJECT_DIR "/config/pendulum.yaml";

struct Entry {
  std::string text;
  bool is_commented_out = false;
  std::string comment;  ///< the lines above it
};

std::string unquoted(const std::string& text) {
  const bool is_quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

/// By key, also those that stand commented out: `#tolerance: 1.0e-6`.
std::map<std::string, Entry> readEntries() {
  std::istringstream lines(readTextFile(kFile));
  std::map<std::string, Entry> entries;
  std::string comment;
  std::string line;
  std::smatch match;
  const std::regex entry("(#?)([a-z_]+): (.*)");
  while (std::getline(lines, line)) {
    if (std::regex_match(line, match, entry)) {
      const bool is_new =
          entries.insert({match[2], {unquoted(match[3]), match[1] == "#", comment}}).second;
      EXPECT_TRUE(is_new) << line;
    }
    if (line.rfind("# ", 0) == 0) {
      comment += line;
    } else {
      comment.clear();
    }
  }
  return entries;
}

TEST(PendulumYaml, GivesEveryParameterItsDefault) {
  const std::map<std::string, Entry> entries = readEntries();
  EXPECT_EQ(entries.size(), parameterTable().size());
  for (const Parameter& parameter : parameterTable()) {
    ASSERT_EQ(entries.count(std::string(parameter.key)), 1U) << parameter.key;
    const Entry& entry = entries.at(std::string(parameter.key));
    const std::string default_text = formatValue(parameter, Scenario{});
    // A number is read, for 1.0e-6 and 1e-06 are the same.
    const std::optional<double> number = parseNumber(default_text);
    EXPECT_EQ(parseNumber(entry.text), number) << parameter.key;
    EXPECT_TRUE(number || entry.text == default_text) << parameter.key;
  }
}

TEST(PendulumYaml, TellsTheUnitOfEveryParameter) {
  for (const auto& [key, entry] : readEntries()) {
    const std::string unit(findParameter(key).unit);
    EXPECT_THAT(entry.comment, testing::HasSubstr(unit.empty() ? "." : ", " + unit)) << key;
  }
}

TEST(PendulumYaml, CommentsOutWhatTheDefaultMethodHasNoUseFor) {
  for (const auto& [key, entry] : readEntries()) {
    const bool is_of_no_use = findParameter(key).applies_to == AppliesTo::kErrorControlled;
    EXPECT_EQ(entry.is_commented_out, is_of_no_use) << key;
  }
}

TEST(PendulumYaml, IsAValidScenario) {
  ScenarioBuilder builder;
  readScenarioFile(kFile, builder);
  const Scenario scenario = builder.build();
  for (const Parameter& parameter : parameterTable()) {
    EXPECT_EQ(formatValue(parameter, scenario), formatValue(parameter, Scenario{}));
  }
}

}  // namespace
}  // namespace spring_pendulum

// config/pendulum.yaml shows every parameter with its default.
#include "base/numbers.hpp"
#include "io/files/text_file.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/io/scenario_file.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr const char* kFile = PROJECT_DIR "/config/pendulum.yaml";

struct Entry {
  std::string text;
  std::string comment;  ///< the lines above it
};

std::string unquoted(const std::string& text) {
  const bool is_quoted = text.size() > 1 && text.front() == '"' && text.back() == '"';
  return is_quoted ? text.substr(1, text.size() - 2) : text;
}

/// By key.
std::map<std::string, Entry> readEntries() {
  std::istringstream lines(readTextFile(kFile));
  std::map<std::string, Entry> entries;
  std::string comment;
  std::string line;
  std::smatch match;
  const std::regex entry("([a-z_]+): (.*)");
  while (std::getline(lines, line)) {
    if (std::regex_match(line, match, entry)) {
      EXPECT_TRUE(entries.insert({match[1], {unquoted(match[2]), comment}}).second) << line;
    }
    if (line.rfind("# ", 0) == 0) {
      comment += line;
    } else {
      comment.clear();
    }
  }
  return entries;
}

TEST(PendulumYaml, GivesEveryOptionItsDefault) {
  const std::map<std::string, Entry> entries = readEntries();
  Scenario scenario;
  const std::vector<Option> options = scenarioOptions(scenario);
  EXPECT_EQ(entries.size(), options.size());
  for (const Option& option : options) {
    ASSERT_EQ(entries.count(std::string(option.key)), 1U) << option.key;
    const Entry& entry = entries.at(std::string(option.key));
    // A number is read, for 1.0e-6 and 1e-06 are the same.
    const std::optional<double> number = parseNumber(option.text());
    EXPECT_EQ(parseNumber(entry.text), number) << option.key;
    EXPECT_TRUE(number || entry.text == option.text()) << option.key;
  }
}

TEST(PendulumYaml, TellsTheUnitOfEveryOption) {
  Scenario scenario;
  const OptionSet options(scenarioOptions(scenario));
  for (const auto& [key, entry] : readEntries()) {
    const std::string unit(options.find(key, kFile).unit);
    EXPECT_THAT(entry.comment, testing::HasSubstr(unit.empty() ? "." : ", " + unit)) << key;
  }
}

TEST(PendulumYaml, WorksWithEveryMethod) {
  const std::string text = readTextFile(kFile);
  for (const Method& method : methodTable()) {
    const std::string line = fmt::format("\nmethod: {}\n", method.name);
    const std::string with_method = std::regex_replace(text, std::regex("\nmethod: .*\n"), line);
    Scenario scenario = parseScenario(with_method, kFile), expected;
    expected.method = method;
    const std::vector<Option> options = scenarioOptions(scenario);
    const std::vector<Option> defaults = scenarioOptions(expected);
    for (std::size_t i = 0; i < options.size(); ++i) {
      EXPECT_EQ(options[i].text(), defaults[i].text()) << options[i].key;
    }
  }
}

}  // namespace
}  // namespace spring_pendulum

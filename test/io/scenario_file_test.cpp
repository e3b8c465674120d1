// Parameters from YAML: what is accepted, and the message for everything that is not.
#include "io/files/posix.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/integration/method_table.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "support/parse_scenario.hpp"
#include <support/bad_text.hpp>

namespace spring_pendulum {
namespace {

using test::BadText;

Scenario parse(const std::string& text) {
  return test::parseScenario(text, "run.yaml");
}

TEST(ScenarioFile, SetsWhatIsGivenAndNothingElse) {
  const Scenario scenario = parse(
      "# a run\n"
      "method: Runge-Kutta-2   # midpoint\n"
      "frames: 7\n"
      "time_step: 1.0e-3\n"
      "damping: 0\n"
      "no_frames: true\n"
      "output: \"a folder\"\n");
  EXPECT_EQ(scenario.method.get().name, "Runge-Kutta-2");
  EXPECT_EQ(scenario.frames, 7);
  EXPECT_EQ(scenario.time_step, 1e-3);
  EXPECT_EQ(scenario.constants.spring.damping, 0.0);
  EXPECT_TRUE(scenario.no_frames);
  EXPECT_EQ(scenario.output, "a folder");
  EXPECT_EQ(scenario.steps_per_frame, Scenario{}.steps_per_frame);
  EXPECT_EQ(scenario.constants.spring.stiffness, Scenario{}.constants.spring.stiffness);
}

TEST(ScenarioFile, MayBeEmpty) {
  for (const char* text : {"", "\n", "# nothing\n", "---\n", "{}\n"})
    EXPECT_EQ(parse(text).frames, Scenario{}.frames) << text;
}

TEST(ScenarioFile, AcceptsFlowStyleAndWindowsLines) {
  EXPECT_EQ(parse("{frames: 3, damping: 0.5}").frames, 3);
  EXPECT_EQ(parse("frames: 3\r\ndamping: 0.5\r\n").constants.spring.damping, 0.5);
}

class ScenarioFileRefuses : public testing::TestWithParam<BadText> {};

TEST_P(ScenarioFileRefuses, WithOneLineThatTellsWhere) {
  try {
    parse(GetParam().text);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(GetParam().message));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rows, ScenarioFileRefuses,
    testing::Values(
        BadText{"frames: 5\nframes: 5\n", "run.yaml:2: frames: is given twice"},
        BadText{"\nframes: 5.5\n",
                "run.yaml:2: frames: must be a whole number of at least 1, got '5.5'"},
        BadText{"frames: 99999999999999999999\n",
                "run.yaml:1: frames: must be a whole number of at least 1, got '9999"},
        BadText{"frames: \"5\"\n",
                "run.yaml:1: frames: must be a whole number of at least 1, "
                "a single value without quotes"},
        BadText{"frames: !!int 5\n", "run.yaml:1: frames: must not have a tag"},
        BadText{"frames:\n", "run.yaml:1: frames: must be a whole"},
        BadText{"method: null\n", "run.yaml:1: method: must be the name of a method"},
        BadText{"frames: [5]\n", "run.yaml:1: frames: must be a whole"},
        BadText{"damping:\n  value: 5\n", "run.yaml:1: damping: must be a number of at least 0"},
        BadText{"damping: .inf\n",
                "run.yaml:1: damping: must be a number of at least 0 N·s/m, got '.inf'"},
        BadText{"no_frames: yes\n", "run.yaml:1: no_frames: must be true or false, got 'yes'"},
        BadText{"no_frames: \"true\"\n", "run.yaml:1: no_frames: must be true or false, a single"},
        BadText{"- frames\n", "run.yaml:1: must be lines 'key: value'"},
        BadText{"[a, b]: 5\n", "run.yaml:1: a key must be a word"},
        BadText{"output: b: c\n", "run.yaml:1: invalid YAML ("},
        BadText{"frames: 5\n}\n", "run.yaml:2: invalid"}, BadText{"frames: [1\n", "run.yaml:"},
        BadText{"frames: *five\n", "run.yaml:1: invalid YAML ("},
        BadText{"frames: 5\n---\ngravity: 1\n", "run.yaml:2: must be a single YAML document"},
        BadText{", 5]\n: &x {c: *x}\n", "run.yaml:"},  // YAML::LoadAll never ends on this
        BadText{"output: \"a\nframes: 5\n", "run.yaml: a quotation mark is not closed"},
        BadText{std::string("frames: 5\noutput: a\0n\n", 22),
                "run.yaml:2: has a control character"},
        BadText{"output: \"a\\0b\"\n", "run.yaml:1: output: must be a folder, got 'a?b'"},
        BadText{"frames: 5\n\x04gravity: 1\n", "run.yaml:2: has a control character"},
        BadText{std::string("\xff\xfe"
                            "f\0:\0",
                            6),
                "run.yaml:1: has a control character"},
        BadText{"frames: " + std::string(100000, '9') + "\n",
                "run.yaml:1: frames: must be a whole number of at least 1, got '" +
                    std::string(40, '9') + "...'"},
        BadText{std::string(20000, '['), "run.yaml"}));

TEST(ScenarioFile, UnknownKeyListsTheKnownOnes) {
  try {
    parse("frames: 1\n\nframse: 5\n");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("run.yaml:3: unknown parameter 'framse'; did you "
                                                  "mean 'frames'? Known parameters: method, "));
    Scenario scenario;
    for (const Option& option : scenarioOptions(scenario))
      EXPECT_THAT(error.what(), testing::HasSubstr(std::string(option.key)));
  }
}

constexpr const char* kFile = PROJECT_DIR "/config/pendulum.yaml";

TEST(PendulumYaml, WorksWithEveryMethod) {
  const std::string text = readTextFile(kFile);
  for (const Method& method : methodTable()) {
    const std::string line = fmt::format("\nmethod: {}\n", method.name);
    const std::string with_method = std::regex_replace(text, std::regex("\nmethod: .*\n"), line);
    Scenario scenario = test::parseScenario(with_method, kFile), expected;
    expected.method = method;
    const std::vector<Option> options = scenarioOptions(scenario);
    const std::vector<Option> defaults = scenarioOptions(expected);
    for (std::size_t i = 0; i < options.size(); ++i)
      EXPECT_EQ(options[i].text(), defaults[i].text()) << options[i].key;
  }
}

}  // namespace
}  // namespace spring_pendulum

// Numbers have a point in files, also in a program that has switched to a decimal comma.
#include "io/formats/frame_writer.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/io/particle_file.hpp>

#include <gtest/gtest.h>

#include <clocale>
#include <locale>

#include "support/parse_scenario.hpp"
#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

class DecimalComma : public testing::Test {
 protected:
  void SetUp() override {
    constexpr const char* kGerman = "de_DE.UTF-8";
    ASSERT_NE(std::setlocale(LC_ALL, kGerman), nullptr) << "needs the Debian package locales-all";
    std::locale::global(std::locale(kGerman));
    ASSERT_STREQ(std::localeconv()->decimal_point, ",");
  }
  void TearDown() override { std::locale::global(std::locale::classic()); }
};

TEST_F(DecimalComma, DoesNotChangeWhatIsReadAndWritten) {
  const TemporaryFolder folder;
  const Scene particles =
      readParticleFile(folder.write("particle.txt", "0.5 0 1\n1234.25 0.5 1\n"));
  EXPECT_EQ(particles.state.x()[1], 1234.25);
  FrameWriter(folder.path()).write(0, particles.state);
  EXPECT_EQ(readFile(folder.path("frame_0000.txt")), "0.5 0\n1234.25 0.5\n");
}

TEST_F(DecimalComma, DoesNotChangeParameters) {
  Scenario scenario = test::parseScenario("time_step: 0.125\nframes: 1000\n", "run.yaml");
  EXPECT_EQ(scenario.time_step, 0.125);
  const OptionSet options(scenarioOptions(scenario));
  EXPECT_EQ(options.find("time_step", "").text(), "0.125");
  EXPECT_EQ(options.find("frames", "").text(), "1000");
}

}  // namespace
}  // namespace spring_pendulum

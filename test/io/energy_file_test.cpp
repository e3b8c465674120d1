#include "io/formats/energy_file.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace spring_pendulum {
namespace {

class EnergyFileTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string read(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string folder_ = testing::TempDir() + "energy_file_" +
                        testing::UnitTest::GetInstance()->current_test_info()->name();
};

EnergyEntry someEntry() {
  EnergyEntry entry;
  entry.time = 0.1;
  entry.energy = {1.0, -2.5, 0.125};
  entry.dissipated = 0.25;
  entry.residual = -1e-17;
  entry.relative_residual = -1e-18;
  return entry;
}

TEST_F(EnergyFileTest, HasARowAFrameUnderAHeaderWithUnits) {
  EnergyFile file(path("e.csv"));
  file.write(0, someEntry(), 0.5);
  file.write(1, someEntry(), 0.5);
  file.finish();
  EXPECT_EQ(read(path("e.csv")),
            "frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated [J],"
            "residual [J],residual/scale [1],position error [m]\n"
            "0,0.1,1,-2.5,0.125,-1.375,0.25,-1e-17,-1e-18,0.5\n"
            "1,0.1,1,-2.5,0.125,-1.375,0.25,-1e-17,-1e-18,0.5\n");
}

TEST_F(EnergyFileTest, IsAbsentUntilItIsWholeAndKeepsTheEarlierOneSoLong) {
  std::ofstream(path("e.csv")) << "earlier";
  {
    EnergyFile file(path("e.csv"));
    for (int i = 0; i < 5000; ++i) file.write(i, someEntry(), 0.5);
    EXPECT_EQ(read(path("e.csv")), "earlier");
  }
  EXPECT_EQ(read(path("e.csv")), "earlier");
  EXPECT_FALSE(std::filesystem::exists(path("e.csv.unfinished")));
}

TEST_F(EnergyFileTest, TellsWhatCameIntoItsWayMeanwhile) {
  EnergyFile file(path("e.csv"));
  file.write(0, someEntry(), 0.5);
  std::filesystem::create_directory(path("e.csv"));
  try {
    file.finish();
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), path("e.csv") + ": could not be written: Is a directory");
  }
}

TEST_F(EnergyFileTest, RefusesASecondWriter) {
  const EnergyFile file(path("e.csv"));
  EXPECT_THROW(EnergyFile second(path("e.csv")), FileError);
}

TEST_F(EnergyFileTest, RefusesWhatIsNoFile) {
  EXPECT_THROW(EnergyFile file(folder_), FileError);
  EXPECT_THROW(EnergyFile file("/dev/null"), FileError);
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  try {
    EnergyFile file(path("absent/"));
    FAIL() << "no error";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), path("absent") + ": is a folder; give a file");
  }
  EXPECT_FALSE(std::filesystem::exists(path("absent")));
}

}  // namespace
}  // namespace spring_pendulum

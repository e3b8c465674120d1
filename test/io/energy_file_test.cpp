#include "io/formats/energy_file.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace spring_pendulum {
namespace {

TEST(EnergyFile, HasARowAFrameUnderAHeaderWithUnits) {
  EnergyEntry entry;
  entry.time = 0.1;
  entry.energy = {1.0, -2.5, 0.125};
  entry.dissipated = 0.25;
  entry.residual = -1e-17;
  entry.relative_residual = -1e-18;
  const TemporaryFolder folder;
  EnergyFile file(folder.path("e.csv"));
  file.write(0, entry, 0.5);
  file.write(1, entry, 0.5);
  file.finish();
  EXPECT_EQ(readFile(folder.path("e.csv")),
            "frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated [J],"
            "residual [J],residual/scale [1],position error [m]\n"
            "0,0.1,1,-2.5,0.125,-1.375,0.25,-1e-17,-1e-18,0.5\n"
            "1,0.1,1,-2.5,0.125,-1.375,0.25,-1e-17,-1e-18,0.5\n");
}

}  // namespace
}  // namespace spring_pendulum

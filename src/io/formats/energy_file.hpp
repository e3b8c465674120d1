// The energy balance of a run as CSV: one row per frame, units in the header.
#pragma once

#include "io/files/output_file.hpp"
#include <spring_pendulum/model/energy.hpp>

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// Writes the energy balance of a run. The file is complete or absent, like every OutputFile.
/// Columns: frame, time in s, kinetic, gravity, spring, total, dissipated and residual energy in J,
/// the residual relative to the energy scale, and the position error in m (nan if not measured).
/// Every number is the shortest text that reads back as the same double.
class EnergyFile {
 public:
  /// \param first frame of the first row; rows of earlier frames that the file has stay in it
  explicit EnergyFile(const std::string& path, std::int64_t first = 0);

  /// \param entry          from an energy balance that tracks the dissipation
  /// \param position_error m; NaN if not measured
  void write(std::int64_t frame, const EnergyEntry& entry, double position_error);

  /// \throws FileError naming the file
  void finish();

  /// Absolute path.
  const std::string& path() const { return file_.path(); }

 private:
  OutputFile file_;
  std::string text_;  ///< rows that are not written yet
};

}  // namespace spring_pendulum

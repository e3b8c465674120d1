// The energy balance of a run as CSV: a row a frame, units in the header.
#pragma once

#include "io/file_descriptor.hpp"
#include <spring_pendulum/simulation/energy_balance.hpp>

#include <cstdint>
#include <string>

namespace spring_pendulum {

/// Writes under the name FILE.unfinished and renames at the end, so FILE is whole or absent; a FILE
/// of an earlier run is replaced only then. Columns: frame, time in s, kinetic, gravity, spring,
/// total, dissipated and residual energy in J, the residual in parts of the energy scale, and the
/// position error in m (nan where it is not measured). Every number is the shortest text that reads back as the same double.
class EnergyFile {
 public:
  /// \throws FileError if the file can't be written, or another run is writing it
  explicit EnergyFile(const std::string& path);
  ~EnergyFile();
  EnergyFile(const EnergyFile&) = delete;
  EnergyFile& operator=(const EnergyFile&) = delete;

  /// \param entry with residual, that is from an energy balance that tracks the dissipation
  /// \throws FileError naming the file
  /// \param position_error m; NaN where it is not measured
  void write(std::int64_t frame, const EnergyEntry& entry, double position_error);

  /// \throws FileError naming the file
  void finish();

 private:
  void flush();
  [[noreturn]] void refuse() const;

  std::string path_;
  std::string unfinished_path_;
  FileDescriptor file_;
  std::string text_;  ///< not yet written
};

}  // namespace spring_pendulum

// The output files of a run on several ranks. The first rank creates, renames and removes them, as
// RunFiles does. Each rank writes its own lines into the unfinished file.
#pragma once

#include "io/files/frame_folder.hpp"
#include "io/files/output_file.hpp"
#include "io/formats/energy_file.hpp"
#include "io/formats/state_file.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <optional>
#include <string>

#include "mpi/chain_part.hpp"
#include "mpi/ranks.hpp"

namespace spring_pendulum {

/// All ranks call all functions, which throw RankFailure.
class SharedFiles {
 public:
  /// \param first number of the first frame
  SharedFiles(const Ranks& ranks, const Scenario& scenario, const std::string& config,
              std::int64_t first);

  /// Writes a frame and a row of the energy balance.
  void write(std::int64_t frame, const ChainPart& part, const EnergyEntry& entry);
  /// Writes the state of the last written frame, if that is wanted, and closes all files.
  void finish(const ChainPart& part);

  /// " to /home/me/frames", empty without frames
  std::string destination() const;
  /// Wall-clock time, s.
  double secondsWriting() const { return seconds_; }

 private:
  /// Writes the texts of all ranks one after the other into an existing file.
  /// \returns its length
  std::int64_t writeTexts(const std::string& path, const std::string& text) const;

  const Ranks& ranks_;
  const Scenario& scenario_;
  std::optional<FrameFolder> frames_;  ///< these three on the first rank
  std::optional<OutputFile> state_;
  std::optional<EnergyFile> energy_;
  std::string text_;
  State last_;  ///< with a state file only
  StateHead last_head_;
  double seconds_ = 0.0;
};

}  // namespace spring_pendulum

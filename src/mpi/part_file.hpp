// The part of a particle file that a rank needs.
#pragma once

#include <spring_pendulum/model/particles.hpp>
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>

#include "mpi/ranks.hpp"

namespace spring_pendulum {

/// The springs first <= i < last of a chain, where spring i is to the right of particle i.
struct Part {
  std::int64_t particles = 0;  ///< of the whole chain
  std::int64_t first = 0;
  std::int64_t last = 0;
  /// Particles first to last. The first one belongs to the rank to the left; it is P_1 on the first rank.
  Particles own;
};

/// Reads the particle file of a scenario, each rank its own part. All ranks call it. The parts begin at
/// the blocks in which energies are summed, see block_sums.hpp.
/// \throws RankFailure
Part readPart(const Ranks& ranks, const Scenario& scenario);

}  // namespace spring_pendulum

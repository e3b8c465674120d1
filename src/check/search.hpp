// Searches for the mistakes that reproduce frames.
#pragma once

#include "check/motion.hpp"

namespace spring_pendulum {

using Methods = std::vector<const Method*>;

/// A program whose mistakes reproduce the frames.
struct Explanation {
  StudentProgram program;
  std::int64_t last_frame;  ///< reproduced up to this frame
};

struct Search {
  const Scenario& scenario;
  const Scene& particles;
  const AllFrames& frames;
  std::size_t known_frames;  ///< number of leading frames without a sign of a mistake
  WorkLimit limit;
  bool gave_up = false;  ///< whether a search ended before everything was tried
};

/// Returns the simplest explanations: a mistake, a wrong number, float, two mistakes, or a mistake and a
/// wrong number.
/// \param only_single whether to try single mistakes only, without fits: the fast part
std::vector<Explanation> findMistakes(Search& search, const Methods& methods,
                                      bool only_single = false);

}  // namespace spring_pendulum

// Fits numbers of a program to frames.
#pragma once

#include <spring_pendulum/model/particles.hpp>

#include <cstddef>
#include <vector>

#include "check/frame_numbers.hpp"
#include "check/mistakes.hpp"
#include "check/motion.hpp"

namespace spring_pendulum {

/// Fits constants of a program to the leading frames by least squares.
/// \param window number of frames
/// \param limit  counts the work; after a stop, the constants are of no use
void fitConstants(StudentProgram& program, const std::vector<const Constant*>& constants,
                  const AllFrames& frames, std::size_t window, const Particles& particles,
                  WorkLimit& limit);

}  // namespace spring_pendulum

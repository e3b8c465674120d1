// The numbers in the text of frames, and how exactly they were printed.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

#include "check/check_frames.hpp"

namespace spring_pendulum {

struct FrameNumbers {
  std::int64_t index = 0;
  Eigen::ArrayX2d positions;  ///< N×2, m; nan and inf as printed
  Eigen::ArrayX2d units;      ///< N×2, one unit of the last digit printed, m
};

struct AllFrames {
  std::vector<FrameNumbers> frames;  ///< by increasing index
  int digits = 0;                    ///< largest number of significant digits
  bool single_precision = false;     ///< printed with 9 digits or more, and each number is a float
  std::vector<std::string> remarks;  ///< on missing frames and on the format

  std::int64_t lastIndex() const { return frames.back().index; }
};

/// \throws FileError naming frame and line
AllFrames readFrames(const std::vector<FrameText>& texts, std::ptrdiff_t particles);

}  // namespace spring_pendulum

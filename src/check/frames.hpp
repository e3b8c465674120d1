// The numbers in the text of frames, and how exactly they were printed.
#pragma once

#include "io/files/frame_folder.hpp"
#include <spring_pendulum/model/scene.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <vector>

namespace spring_pendulum {

struct FrameNumbers {
  std::int64_t index = 0;
  Eigen::ArrayX2d positions;  ///< N×2, m; nan and inf as printed
  Eigen::ArrayX2d units;      ///< N×2, one unit of the last digit printed, m

  /// \param share of a unit by which numbers may differ
  bool equals(const Eigen::ArrayX2d& numbers, double share) const {
    return ((positions - numbers).abs() <= share * units).all();
  }
};

struct AllFrames {
  std::vector<FrameNumbers> frames;  ///< by increasing index
  int digits = 0;                    ///< largest number of significant digits
  bool are_floats = false;           ///< whether a program in float has written them
  std::int64_t start = 0;            ///< index of the frame that should be the start
  std::vector<std::string> notes;    ///< on missing frames and on the format

  /// If the first frame is the start with another index, lets it have that of the start.
  bool renumber(const Eigen::ArrayX2d& positions);
};

/// \throws FileError naming frame and line
AllFrames readFrames(const std::vector<FrameText>& texts, const Scene& particles);

}  // namespace spring_pendulum

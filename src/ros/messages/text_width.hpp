// The width of texts in rviz, which draws them centred.
#pragma once

#include <string>

namespace spring_pendulum {

/// Width of a text in the font of rviz, in text heights. Liberation Sans has the widths of Helvetica;
/// rviz makes a space as wide as an A.
inline double textWidth(const std::string& text) {
  // From '!' to 'z', in 1/1000 of the font size.
  constexpr int kWidths[] = {
      278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278,  278, 556, 556, 556,
      556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722,
      667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722,  667, 611, 722, 667,
      944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,  556, 278, 556, 556,
      222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500,  722, 500, 500, 500};
  constexpr double kFontSize = 0.87;  ///< in text heights
  int sum = 0;
  for (const char c : text) sum += kWidths[c > ' ' && c <= 'z' ? c - '!' : 'A' - '!'];
  return 1e-3 * kFontSize * sum;
}

}  // namespace spring_pendulum

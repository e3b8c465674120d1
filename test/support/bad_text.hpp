// A text that a reader must refuse.
#pragma once

#include <ostream>
#include <string>

namespace spring_pendulum::test {

struct BadText {
  std::string text;
  std::string message;  ///< that it is refused with, or how that starts
};

/// GoogleTest names a failing row by this.
inline std::ostream& operator<<(std::ostream& stream, const BadText& bad) {
  return stream << bad.message;
}

}  // namespace spring_pendulum::test

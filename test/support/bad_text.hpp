// A text that a reader must refuse.
#pragma once

#include <ostream>
#include <string>

namespace spring_pendulum::test {

struct BadText {
  std::string text;
  std::string message;  ///< beginning of the error message
};

/// GoogleTest prints this for a failing row.
inline std::ostream& operator<<(std::ostream& stream, const BadText& bad) {
  return stream << bad.message;
}

}  // namespace spring_pendulum::test

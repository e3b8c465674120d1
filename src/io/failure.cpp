#include "io/failure.hpp"

#include "io/text_file.hpp"
#include <spring_pendulum/model/errors.hpp>

#include <new>

namespace spring_pendulum {

Failure failureOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {"not enough memory for a chain of this length", kFileFailed};
  }
  const bool bad_input = dynamic_cast<const InputError*>(&error) != nullptr;
  return {onOneLine(error.what()), bad_input ? kBadInput : kFileFailed};
}

}  // namespace spring_pendulum

#include <spring_pendulum/io/failure.hpp>
#include <spring_pendulum/model/errors.hpp>

#include <algorithm>
#include <new>

namespace spring_pendulum {

Failure failureOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {"not enough memory for a chain of this length", kFileFailed};
  }
  std::string message = error.what();
  std::replace_if(
      message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return {message, dynamic_cast<const InputError*>(&error) != nullptr ? kBadInput : kFileFailed};
}

}  // namespace spring_pendulum

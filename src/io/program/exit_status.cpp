#include "io/program/exit_status.hpp"

#include "base/spelling.hpp"
#include "io/program/standard_streams.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <new>

namespace spring_pendulum {

Failure failureOf(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    return {"not enough memory for a chain of this length", kFileFailed};
  }
  const bool bad_input = dynamic_cast<const InputError*>(&error) != nullptr;
  return {onOneLine(error.what()), bad_input ? kBadInput : kFileFailed};
}

int runProgram(const std::function<int()>& program,
               const std::function<void(const std::string&)>& report) {
  prepareProcess();
  try {
    const int status = program();
    flushOutput();
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    report ? report(failure.message) : printError(failure.message + "\n");
    return failure.status;
  }
}

}  // namespace spring_pendulum

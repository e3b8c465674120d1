// Answers of services: a sentence, and whether it tells of success.
#pragma once

#include <exception>

namespace spring_pendulum {

/// Calls a function and answers with its sentence, or with the error.
template <typename Response, typename Function>
bool answer(Response& response, const Function& function) {
  try {
    response.message = function();
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = 0;
  }
  return true;
}

}  // namespace spring_pendulum

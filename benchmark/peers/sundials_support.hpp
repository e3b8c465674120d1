// Common code of the SUNDIALS peers: ownership of handles and a check of return values.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <string>

#include "../peer.hpp"
#include "plain_force.hpp"

namespace spring_pendulum::benchmark {

inline void requireSuccess(int status, const char* call) {
  if (status < 0) throw PeerError(std::string(call) + " returned " + std::to_string(status));
}

class SundialsContext {
 public:
  SundialsContext() { requireSuccess(SUNContext_Create(nullptr, &context_), "SUNContext_Create"); }
  ~SundialsContext() { SUNContext_Free(&context_); }
  SundialsContext(const SundialsContext&) = delete;
  SundialsContext& operator=(const SundialsContext&) = delete;
  SUNContext get() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

class SundialsVector {
 public:
  SundialsVector(std::size_t size, const SundialsContext& context)
      : size_(size), vector_(N_VNew_Serial(static_cast<sunindextype>(size), context.get())) {}
  ~SundialsVector() { N_VDestroy(vector_); }
  SundialsVector(const SundialsVector&) = delete;
  SundialsVector& operator=(const SundialsVector&) = delete;
  N_Vector get() const { return vector_; }
  double* data() { return NV_DATA_S(vector_); }
  const double* data() const { return NV_DATA_S(vector_); }
  std::size_t size() const { return size_; }

 private:
  std::size_t size_;
  N_Vector vector_;
};

/// Suppresses messages of SUNDIALS; its return values are checked.
inline void dropMessage(int /*code*/, const char* /*module*/, const char* /*function*/,
                        char* /*message*/, void* /*data*/) {}

/// A CVRhsFn and ERKRhsFn; `force` is a PlainForce.
inline int derivative(realtype /*time*/, N_Vector state, N_Vector slope, void* force) {
  (*static_cast<PlainForce*>(force))(NV_DATA_S(state), NV_DATA_S(slope));
  return 0;
}

constexpr long kUnlimitedSteps = 2'000'000'000;

}  // namespace spring_pendulum::benchmark

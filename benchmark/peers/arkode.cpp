// SUNDIALS ARKODE, module ERKStep: explicit Runge-Kutta methods, with the classical tableau at a
// fixed step and with its own pairs under error control.
#include <arkode/arkode_erkstep.h>

#include <algorithm>

#include "plain_force.hpp"
#include "rows.hpp"
#include "sundials_support.hpp"

namespace spring_pendulum::benchmark {
namespace {

class ArkodePeer : public Peer {
 public:
  ArkodePeer(const Problem& problem, const Run& run, int order)
      : start_(problem.start), force_(problem), run_(run), state_(start_.size(), context_) {
    std::copy(start_.begin(), start_.end(), state_.data());
    memory_ = ERKStepCreate(derivative, 0.0, state_.get(), context_.get());
    if (memory_ == nullptr) throw PeerError("ERKStepCreate failed");
    ERKStepSetErrHandlerFn(memory_, dropMessage, nullptr);
    requireSuccess(ERKStepSetUserData(memory_, &force_), "ERKStepSetUserData");
    requireSuccess(ERKStepSetMaxNumSteps(memory_, kUnlimitedSteps), "ERKStepSetMaxNumSteps");
    if (run.tolerance > 0.0) {
      requireSuccess(ERKStepSetOrder(memory_, order), "ERKStepSetOrder");
      requireSuccess(ERKStepSStolerances(memory_, run.tolerance, run.tolerance),
                     "ERKStepSStolerances");
    } else {
      setClassicalTableau();
      requireSuccess(ERKStepSetFixedStep(memory_, run.time_step), "ERKStepSetFixedStep");
    }
  }
  ~ArkodePeer() override { ERKStepFree(&memory_); }

  void reset() override {
    std::copy(start_.begin(), start_.end(), state_.data());
    time_ = 0.0;
    requireSuccess(ERKStepReset(memory_, 0.0, state_.get()), "ERKStepReset");
  }

  void advance() override {
    const double end = time_ + run_.time_step * static_cast<double>(run_.steps);
    if (run_.tolerance == 0.0) {  // the last step ends within rounding of the output time
      requireSuccess(ERKStepSetStopTime(memory_, end), "ERKStepSetStopTime");
    }
    requireSuccess(ERKStepEvolve(memory_, end, state_.get(), &time_, ARK_NORMAL), "ERKStepEvolve");
  }

  std::vector<double> state() const override {
    return {state_.data(), state_.data() + state_.size()};
  }
  std::int64_t forceEvaluations() const override { return force_.evaluations(); }

 private:
  void setClassicalTableau() {
    // The last node should be 1. SUNDIALS 6.4 would then reuse the last stage as the first of the
    // next step and lose an order. The value does not matter, as F does not depend on time.
    realtype c[] = {0.0, 0.5, 0.5, 0.75};
    realtype a[] = {0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    realtype b[] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    ARKodeButcherTable table = ARKodeButcherTable_Create(4, 4, 0, c, a, b, nullptr);
    const int status = ERKStepSetTable(memory_, table);
    ARKodeButcherTable_Free(table);
    requireSuccess(status, "ERKStepSetTable");
  }

  const std::vector<double>& start_;
  PlainForce force_;
  Run run_;
  SundialsContext context_;
  SundialsVector state_;
  void* memory_ = nullptr;
  double time_ = 0.0;
};

}  // namespace

std::vector<PeerRow> arkodeRows() {
  const auto controlled = Stepping::kErrorControlled;
  return {{"SUNDIALS", "ARKODE classical tableau", Stepping::kFixed, true, makerOf<ArkodePeer>(4)},
          {"SUNDIALS", "ARKODE order 5", controlled, false, makerOf<ArkodePeer>(5)},
          {"SUNDIALS", "ARKODE order 8", controlled, false, makerOf<ArkodePeer>(8)}};
}

}  // namespace spring_pendulum::benchmark

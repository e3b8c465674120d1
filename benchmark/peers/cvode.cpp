// SUNDIALS CVODE: Adams with fixed-point iteration, and BDF with Newton iteration, its band solver
// and either difference quotients or the exact Jacobian.
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <algorithm>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "plain_force.hpp"
#include "rows.hpp"
#include "sundials_support.hpp"

namespace spring_pendulum::benchmark {
namespace {

enum class Formula { kAdams, kBdf, kBdfExactJacobian };

constexpr sunindextype kUpper = 5;
constexpr sunindextype kLower = 7;

int interleavedDerivative(realtype /*time*/, N_Vector state, N_Vector slope, void* force) {
  static_cast<PlainForce*>(force)->interleaved(NV_DATA_S(state), NV_DATA_S(slope));
  return 0;
}

int exactJacobian(realtype /*time*/, N_Vector state, N_Vector /*slope*/, SUNMatrix matrix,
                  void* force, N_Vector /*a*/, N_Vector /*b*/, N_Vector /*c*/) {
  SUNMatZero(matrix);
  std::vector<double*> columns(static_cast<std::size_t>(SM_COLUMNS_B(matrix)));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    columns[j] = SM_COLUMN_B(matrix, static_cast<sunindextype>(j));
  }
  static_cast<PlainForce*>(force)->interleavedJacobian(NV_DATA_S(state), columns.data());
  return 0;
}

class CvodePeer : public Peer {
 public:
  CvodePeer(const Problem& problem, const Run& run, Formula formula)
      : start_(problem.start),
        force_(problem),
        run_(run),
        formula_(formula),
        state_(start_.size(), context_) {
    load();
    memory_ = CVodeCreate(formula == Formula::kAdams ? CV_ADAMS : CV_BDF, context_.get());
    if (memory_ == nullptr) throw PeerError("CVodeCreate failed");
    CVodeSetErrHandlerFn(memory_, dropMessage, nullptr);
    const bool adams = formula == Formula::kAdams;
    requireSuccess(
        CVodeInit(memory_, adams ? derivative : interleavedDerivative, 0.0, state_.get()),
        "CVodeInit");
    requireSuccess(CVodeSetUserData(memory_, &force_), "CVodeSetUserData");
    requireSuccess(CVodeSStolerances(memory_, run.tolerance, run.tolerance), "CVodeSStolerances");
    requireSuccess(CVodeSetMaxNumSteps(memory_, kUnlimitedSteps), "CVodeSetMaxNumSteps");
    if (adams) {
      nonlinear_solver_ = SUNNonlinSol_FixedPoint(state_.get(), 0, context_.get());
      requireSuccess(CVodeSetNonlinearSolver(memory_, nonlinear_solver_),
                     "CVodeSetNonlinearSolver");
    } else {
      setBandSolver();
    }
  }

  ~CvodePeer() override {
    CVodeFree(&memory_);
    if (nonlinear_solver_ != nullptr) SUNNonlinSolFree(nonlinear_solver_);
    if (linear_solver_ != nullptr) SUNLinSolFree(linear_solver_);
    if (matrix_ != nullptr) SUNMatDestroy(matrix_);
  }

  void reset() override {
    load();
    time_ = 0.0;
    requireSuccess(CVodeReInit(memory_, 0.0, state_.get()), "CVodeReInit");
  }

  void advance() override {
    const double end = time_ + run_.time_step * static_cast<double>(run_.steps);
    requireSuccess(CVode(memory_, end, state_.get(), &time_, CV_NORMAL), "CVode");
  }

  std::vector<double> state() const override {
    std::vector<double> result(state_.data(), state_.data() + state_.size());
    if (formula_ != Formula::kAdams) separate(force_.size(), state_.data(), result.data());
    return result;
  }
  std::int64_t forceEvaluations() const override { return force_.evaluations(); }

 private:
  void load() {
    if (formula_ == Formula::kAdams) {
      std::copy(start_.begin(), start_.end(), state_.data());
    } else {
      interleave(force_.size(), start_.data(), state_.data());
    }
  }

  void setBandSolver() {
    matrix_ =
        SUNBandMatrix(static_cast<sunindextype>(state_.size()), kUpper, kLower, context_.get());
    linear_solver_ = SUNLinSol_Band(state_.get(), matrix_, context_.get());
    requireSuccess(CVodeSetLinearSolver(memory_, linear_solver_, matrix_), "CVodeSetLinearSolver");
    if (formula_ == Formula::kBdfExactJacobian) {
      requireSuccess(CVodeSetJacFn(memory_, exactJacobian), "CVodeSetJacFn");
    }
  }

  const std::vector<double>& start_;
  PlainForce force_;
  Run run_;
  Formula formula_;
  SundialsContext context_;
  SundialsVector state_;
  void* memory_ = nullptr;
  SUNNonlinearSolver nonlinear_solver_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_solver_ = nullptr;
  double time_ = 0.0;
};

}  // namespace

std::vector<PeerRow> cvodeRows() {
  const auto controlled = Stepping::kErrorControlled;
  return {{"SUNDIALS", "CVODE Adams", controlled, false, makerOf<CvodePeer>(Formula::kAdams)},
          {"SUNDIALS", "CVODE BDF", controlled, false, makerOf<CvodePeer>(Formula::kBdf)},
          {"SUNDIALS", "CVODE BDF (exact Jacobian)", controlled, false,
           makerOf<CvodePeer>(Formula::kBdfExactJacobian)}};
}

}  // namespace spring_pendulum::benchmark

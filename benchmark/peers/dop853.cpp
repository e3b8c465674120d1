// DOP853, the compiled Fortran by E. Hairer that SciPy contains.
//
// SciPy's library exports only its Python module. The attribute `_cpointer` of the function
// `dop853` holds the address of the Fortran routine. The interpreter is started once to read this
// address and does not take part in the timing.
//
// Reference: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd
// ed., Springer 1993; http://www.unige.ch/~hairer/prog/nonstiff/dop853.f describes the arguments.
#include <fmt/format.h>

#include <Python.h>
#include <algorithm>
#include <array>

#include "plain_force.hpp"
#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

using Derivative = void(const int* size, const double* time, const double* state, double* slope,
                        void* force, int* unused);
using Output = void();

/// The Fortran subroutine. It passes `real_data` and `integer_data` to the derivative.
using Dop853 = void(const int* size, Derivative*, double* time, double* state, const double* end,
                    const double* relative_tolerance, const double* absolute_tolerance,
                    const int* tolerance_kind, Output*, const int* output_kind, double* work,
                    const int* work_size, int* integer_work, const int* integer_work_size,
                    void* real_data, int* integer_data, int* result);

void derivative(const int* /*size*/, const double* /*time*/, const double* state, double* slope,
                void* force, int* /*unused*/) {
  (*static_cast<PlainForce*>(force))(state, slope);
}

void noOutput() {}

Dop853* findDop853() {
  Py_InitializeEx(0);  // 0: leaves the signals alone
  PyObject* module = PyImport_ImportModule("scipy.integrate._dop");
  PyObject* function = module == nullptr ? nullptr : PyObject_GetAttrString(module, "dop853");
  PyObject* capsule = function == nullptr ? nullptr : PyObject_GetAttrString(function, "_cpointer");
  void* address = capsule == nullptr ? nullptr : PyCapsule_GetPointer(capsule, nullptr);
  PyErr_Clear();
  return reinterpret_cast<Dop853*>(address);  // module and interpreter live until the end
}

class Dop853Peer : public Peer {
 public:
  Dop853Peer(const Problem& problem, const Run& run, Dop853* solve)
      : start_(problem.start),
        force_(problem),
        run_(run),
        solve_(solve),
        state_(problem.start),
        work_(11 * problem.start.size() + 21) {}

  void reset() override {
    state_ = start_;
    time_ = 0.0;
  }

  void advance() override {
    const int size = static_cast<int>(state_.size());
    const int work_size = static_cast<int>(work_.size());
    const int integer_work_size = static_cast<int>(integer_work_.size());
    const int one_tolerance = 0;
    const int without_output = 0;
    const double end = time_ + run_.time_step * static_cast<double>(run_.steps);
    std::fill(work_.begin(), work_.end(), 0.0);  // 0: the default of each setting
    integer_work_ = {};
    integer_work_[0] = 1'000'000'000;  // steps at most
    integer_work_[2] = -1;             // prints nothing
    integer_work_[3] = -1;             // never ends because the problem seems to be stiff
    int result = 0;
    solve_(&size, derivative, &time_, state_.data(), &end, &run_.tolerance, &run_.tolerance,
           &one_tolerance, noOutput, &without_output, work_.data(), &work_size,
           integer_work_.data(), &integer_work_size, &force_, nullptr, &result);
    if (result < 0) throw PeerError(fmt::format("DOP853 returned {}", result));
  }

  std::vector<double> state() const override { return state_; }
  std::int64_t forceEvaluations() const override { return force_.evaluations(); }

 private:
  const std::vector<double>& start_;
  PlainForce force_;
  Run run_;
  Dop853* solve_;
  std::vector<double> state_;
  std::vector<double> work_;
  std::array<int, 21> integer_work_{};
  double time_ = 0.0;
};

}  // namespace

std::vector<PeerRow> dop853Rows() {
  Dop853* const solve = findDop853();
  if (solve == nullptr) return {};
  return {{"SciPy", "DOP853", Stepping::kErrorControlled, false, makerOf<Dop853Peer>(solve)}};
}

}  // namespace spring_pendulum::benchmark

// The GNU Scientific Library. Its rk4 always estimates the error by step doubling, which costs 11
// evaluations of the right-hand side per step instead of 4.
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "plain_force.hpp"
#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

int derivative(double /*time*/, const double* state, double* slope, void* force) {
  (*static_cast<PlainForce*>(force))(state, slope);
  return GSL_SUCCESS;
}

class GslPeer : public Peer {
 public:
  GslPeer(const Problem& problem, const Run& run, const gsl_odeiv2_step_type* type)
      : start_(problem.start),
        force_(problem),
        run_(run),
        state_(problem.start),
        system_{derivative, nullptr, start_.size(), &force_} {
    gsl_set_error_handler_off();
    const double tolerance = run.tolerance > 0.0 ? run.tolerance : 1.0;
    const double first_step = run.tolerance > 0.0 ? 1e-3 : run.time_step;
    driver_ = gsl_odeiv2_driver_alloc_y_new(&system_, type, first_step, tolerance, tolerance);
    if (driver_ == nullptr) throw PeerError("gsl_odeiv2_driver_alloc_y_new failed");
  }
  ~GslPeer() override { gsl_odeiv2_driver_free(driver_); }

  void reset() override {
    state_ = start_;
    time_ = 0.0;
    gsl_odeiv2_driver_reset_hstart(driver_, run_.tolerance > 0.0 ? 1e-3 : run_.time_step);
  }

  void advance() override {
    int status = GSL_SUCCESS;
    if (run_.tolerance > 0.0) {
      const double end = time_ + run_.time_step * static_cast<double>(run_.steps);
      status = gsl_odeiv2_driver_apply(driver_, &time_, end, state_.data());
    } else {
      status = gsl_odeiv2_driver_apply_fixed_step(
          driver_, &time_, run_.time_step, static_cast<unsigned long>(run_.steps), state_.data());
    }
    if (status != GSL_SUCCESS) throw PeerError(gsl_strerror(status));
  }

  std::vector<double> state() const override { return state_; }
  std::int64_t forceEvaluations() const override { return force_.evaluations(); }

 private:
  const std::vector<double>& start_;
  PlainForce force_;
  Run run_;
  std::vector<double> state_;
  gsl_odeiv2_system system_;
  gsl_odeiv2_driver* driver_ = nullptr;
  double time_ = 0.0;
};

}  // namespace

std::vector<PeerRow> gslRows() {
  const auto controlled = Stepping::kErrorControlled;
  return {{"GSL", "GSL rk4", Stepping::kFixed, true, makerOf<GslPeer>(gsl_odeiv2_step_rk4)},
          {"GSL", "GSL rk8pd", controlled, false, makerOf<GslPeer>(gsl_odeiv2_step_rk8pd)},
          {"GSL", "GSL msadams", controlled, false, makerOf<GslPeer>(gsl_odeiv2_step_msadams)}};
}

}  // namespace spring_pendulum::benchmark

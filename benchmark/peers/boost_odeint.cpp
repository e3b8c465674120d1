// Boost.odeint, with std::vector and with Eigen states.
//
// This file is compiled with the vector flags of the machine, which change the layout and the
// allocator of Eigen's types. Its Eigen therefore is in a separate namespace, so that the linker
// does not mix it with the Eigen of the library.
#define Eigen EigenOfTheBoostPeer

#include <Eigen/Core>
#include <boost/numeric/odeint.hpp>
#include <boost/numeric/odeint/external/eigen/eigen.hpp>

#include "plain_force.hpp"
#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

namespace odeint = boost::numeric::odeint;
using VectorState = std::vector<double>;
using EigenState = Eigen::VectorXd;
constexpr double kFirstStep = 1e-3;  // s, first step size of an error-controlled method

template <typename State>
class BoostPeer : public Peer {
 public:
  BoostPeer(const Problem& problem, const Run& run)
      : start_(problem.start), force_(problem), run_(run) {
    reset();
  }

  void reset() override {
    state_.resize(static_cast<decltype(state_.size())>(start_.size()));
    std::copy(start_.begin(), start_.end(), state_.data());
  }
  std::vector<double> state() const override {
    return {state_.data(), state_.data() + state_.size()};
  }
  std::int64_t forceEvaluations() const override { return force_.evaluations(); }

 protected:
  auto system() {
    return [this](const State& z, State& derivative, double /*time*/) {
      force_(z.data(), derivative.data());
    };
  }
  double duration() const { return run_.time_step * static_cast<double>(run_.steps); }
  const Run& run() const { return run_; }
  State& current() { return state_; }

 private:
  const std::vector<double>& start_;
  PlainForce force_;
  Run run_;
  State state_;
};

template <typename State, typename Stepper>
class FixedBoostPeer : public BoostPeer<State> {
 public:
  using BoostPeer<State>::BoostPeer;
  void advance() override {
    const double h = this->run().time_step;
    for (std::int64_t n = 0; n < this->run().steps; ++n) {
      stepper_.do_step(this->system(), this->current(), static_cast<double>(n) * h, h);
    }
  }

 private:
  Stepper stepper_;
};

template <typename State, typename ErrorStepper>
class ControlledBoostPeer : public BoostPeer<State> {
 public:
  using BoostPeer<State>::BoostPeer;
  void advance() override {
    const double tolerance = this->run().tolerance;
    odeint::integrate_adaptive(odeint::make_controlled(tolerance, tolerance, ErrorStepper()),
                               this->system(), this->current(), 0.0, this->duration(), kFirstStep);
  }
};

template <typename State>
class BulirschStoerPeer : public BoostPeer<State> {
 public:
  using BoostPeer<State>::BoostPeer;
  void advance() override {
    const double tolerance = this->run().tolerance;
    odeint::integrate_adaptive(odeint::bulirsch_stoer<State>(tolerance, tolerance), this->system(),
                               this->current(), 0.0, this->duration(), kFirstStep);
  }
};

using odeint::vector_space_algebra;

}  // namespace

std::vector<PeerRow> boostRows() {
  using Rk4 = odeint::runge_kutta4<VectorState>;
  using EigenRk4 =
      odeint::runge_kutta4<EigenState, double, EigenState, double, vector_space_algebra>;
  using Dopri5 =
      odeint::runge_kutta_dopri5<EigenState, double, EigenState, double, vector_space_algebra>;
  using Rkf78 =
      odeint::runge_kutta_fehlberg78<EigenState, double, EigenState, double, vector_space_algebra>;
  const auto controlled = Stepping::kErrorControlled;
  return {{"Boost.odeint", "Boost runge_kutta4 (vector)", Stepping::kFixed, true,
           makerOf<FixedBoostPeer<VectorState, Rk4>>()},
          {"Boost.odeint", "Boost runge_kutta4 (Eigen)", Stepping::kFixed, true,
           makerOf<FixedBoostPeer<EigenState, EigenRk4>>()},
          {"Boost.odeint", "Boost dopri5", controlled, false,
           makerOf<ControlledBoostPeer<EigenState, Dopri5>>()},
          {"Boost.odeint", "Boost rkf78", controlled, false,
           makerOf<ControlledBoostPeer<EigenState, Rkf78>>()},
          {"Boost.odeint", "Boost bulirsch_stoer", controlled, false,
           makerOf<BulirschStoerPeer<VectorState>>()}};
}

}  // namespace spring_pendulum::benchmark

// This package: every row of its method table.
#include <spring_pendulum/integration/method_table.hpp>
#include <spring_pendulum/model/chain.hpp>

#include <algorithm>

#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

Chain chainOf(const Problem& problem) {
  return {Eigen::Map<const Eigen::VectorXd>(problem.masses.data(),
                                            static_cast<Eigen::Index>(problem.size())),
          SpringLaw{problem.stiffness, problem.damping, problem.rest_length}, problem.gravity};
}

IntegratorOptions optionsOf(const Run& run) {
  IntegratorOptions options;
  if (run.tolerance > 0.0) options.tolerance = run.tolerance;
  options.threads = run.threads;
  options.track_dissipation = run.energy;
  return options;
}

class OwnPeer : public Peer {
 public:
  OwnPeer(const Problem& problem, const Run& run, std::string_view method)
      : run_(run),
        start_(problem.start),
        integrator_(makeIntegrator(method, chainOf(problem), optionsOf(run))),
        state_(static_cast<Eigen::Index>(problem.size())) {
    reset();
  }

  void reset() override {
    std::copy(start_.begin(), start_.end(), state_.values().data());
    integrator_->restart();
  }

  void advance() override { integrator_->advance(state_, run_.time_step, run_.steps); }

  std::vector<double> state() const override {
    return {state_.values().data(), state_.values().data() + state_.values().size()};
  }

  std::int64_t forceEvaluations() const override { return integrator_->forceEvaluations(); }

 private:
  Run run_;
  const std::vector<double>& start_;  ///< the problem outlives its peers
  std::unique_ptr<Integrator> integrator_;
  State state_;
};

}  // namespace

std::vector<PeerRow> ownRows() {
  std::vector<PeerRow> rows;
  for (const Method& method : methodTable()) {
    const bool fixed = method.hasFixedStep();
    rows.push_back({"own", std::string(method.name),
                    fixed ? Stepping::kFixed : Stepping::kErrorControlled,
                    method.name == "Runge-Kutta-4", makerOf<OwnPeer>(method.name)});
  }
  return rows;
}

}  // namespace spring_pendulum::benchmark

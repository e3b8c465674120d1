// Simbody with its Runge-Kutta-Merson integrator: a Translation mobilizer per particle (no
// rotation), a two-point spring and a two-point damper per spring.
#include <Simbody.h>

#include "rows.hpp"

namespace spring_pendulum::benchmark {
namespace {

class SimbodyPeer : public Peer {
 public:
  SimbodyPeer(const Problem& problem, const Run& run)
      : problem_(problem),
        run_(run),
        matter_(system_),
        forces_(system_),
        gravity_(forces_, matter_, SimTK::Vec3(0.0, -problem.gravity, 0.0)),
        integrator_(system_) {
    const std::size_t n = problem.size();
    bodies_.push_back(matter_.Ground());
    for (std::size_t i = 1; i < n; ++i) {
      const SimTK::Body::Rigid body(
          SimTK::MassProperties(problem.masses[i], SimTK::Vec3(0.0), SimTK::Inertia(0.0)));
      SimTK::MobilizedBody::Translation mobilizer(matter_.Ground(), body);
      bodies_.push_back(mobilizer);
      const SimTK::Vec3 near = i == 1 ? place(0) : SimTK::Vec3(0.0);
      // The objects are handles; the subsystem owns the forces.
      // NOLINTNEXTLINE(bugprone-unused-raii)
      SimTK::Force::TwoPointLinearSpring(forces_, bodies_[i - 1], near, mobilizer, SimTK::Vec3(0.0),
                                         problem.stiffness, problem.rest_length);
      // NOLINTNEXTLINE(bugprone-unused-raii)
      SimTK::Force::TwoPointLinearDamper(forces_, bodies_[i - 1], near, mobilizer, SimTK::Vec3(0.0),
                                         problem.damping);
    }
    start_ = system_.realizeTopology();
    system_.realizeModel(start_);
    for (std::size_t i = 1; i < n; ++i) {
      static_cast<const SimTK::MobilizedBody::Translation&>(bodies_[i])
          .setQToFitTranslation(start_, place(i));
    }
    if (run.tolerance >= 1.0) throw PeerError("its accuracy must be below 1");
    integrator_.setAccuracy(run.tolerance);
    reset();
  }

  void reset() override { integrator_.initialize(start_); }

  void advance() override {
    try {
      const double end = integrator_.getTime() + run_.time_step * static_cast<double>(run_.steps);
      while (integrator_.stepTo(end) != SimTK::Integrator::ReachedReportTime) {
        // stepTo also returns at the start of a motion.
      }
    } catch (const std::exception& error) {
      throw PeerError(error.what());
    }
  }

  std::vector<double> state() const override {
    const std::size_t n = problem_.size();
    std::vector<double> z = problem_.start;
    const SimTK::State& state = integrator_.getState();
    system_.realize(state, SimTK::Stage::Velocity);
    for (std::size_t i = 1; i < n; ++i) {
      const SimTK::Vec3 p = bodies_[i].getBodyOriginLocation(state);
      const SimTK::Vec3 v = bodies_[i].getBodyOriginVelocity(state);
      for (int c = 0; c < 2; ++c) {
        z[static_cast<std::size_t>(c) * n + i] = p[c];
        z[static_cast<std::size_t>(2 + c) * n + i] = v[c];
      }
    }
    return z;
  }
  std::int64_t forceEvaluations() const override { return integrator_.getNumRealizations(); }

 private:
  SimTK::Vec3 place(std::size_t i) const {
    return {problem_.start[i], problem_.start[problem_.size() + i], 0.0};
  }

  const Problem& problem_;
  Run run_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  SimTK::GeneralForceSubsystem forces_;
  SimTK::Force::UniformGravity gravity_;
  std::vector<SimTK::MobilizedBody> bodies_;
  SimTK::State start_;
  SimTK::RungeKuttaMersonIntegrator integrator_;
};

}  // namespace

std::vector<PeerRow> simbodyRows() {
  return {{"Simbody", "Simbody Runge-Kutta-Merson", Stepping::kErrorControlled, false,
           makerOf<SimbodyPeer>()}};
}

}  // namespace spring_pendulum::benchmark

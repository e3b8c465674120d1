// The energy that a chain loses and receives, integrated along with its motion.
#pragma once

#include "integration/kernels/dissipated_energy.hpp"
#include "integration/kernels/state_buffer.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <vector>

namespace spring_pendulum {

/// Sums the work done on the held particles of a chain other than P_1, which is at rest where
/// integrators compute. Free of cost without such particles.
class HeldWork {
 public:
  explicit HeldWork(const Chain& chain)
      : spring_(chain.spring()), first_spring_(chain.firstSpring()) {
    for (Eigen::Index i = 1; i < chain.size(); ++i) {
      if (chain.isHeld(i)) held_.push_back(i);
    }
  }

  bool isNeeded() const { return !held_.empty(); }
  void reset() { work_ = 0.0; }
  double total() const { return work_; }  ///< J

  /// Adds the power at a state times `time` s.
  void add(const StateBuffer& state, double time) {
    const Eigen::Index pitch = state.pitch();
    double power = 0.0;
    for (const Eigen::Index i : held_) {
      const double* z = state.particle(i);
      const auto add_spring = [&](Eigen::Index other) {
        const auto difference = [&](Eigen::Index column) {
          return z[column * pitch + other] - z[column * pitch];
        };
        const PlaneVector<double> separation{difference(0), difference(1)};
        const PlaneVector<double> relative_velocity{difference(2), difference(3)};
        const PlaneVector<double> force = springForce(spring_, separation, relative_velocity);
        power -= force.x * z[2 * pitch] + force.y * z[3 * pitch];
      };
      if (i > first_spring_) add_spring(-1);
      if (i + 1 < state.size()) add_spring(1);
    }
    work_ += time * power;
  }

 private:
  SpringLaw spring_;
  Eigen::Index first_spring_;
  std::vector<Eigen::Index> held_;
  double work_ = 0.0;
};

/// Sums the dissipated energy, if that is tracked, and the work of holders.
class EnergyFlow {
 public:
  EnergyFlow(const Chain& chain, bool track_dissipation)
      : track_dissipation_(track_dissipation),
        dissipated_(track_dissipation ? DissipatedEnergy(chain) : DissipatedEnergy()),
        held_work_(chain) {}

  bool isNeeded() const { return track_dissipation_ || held_work_.isNeeded(); }
  /// Empty if the energy is not tracked.
  DissipatedEnergy& dissipated() { return dissipated_; }
  const DissipatedEnergy& dissipated() const { return dissipated_; }
  double supplied() const { return held_work_.total(); }  ///< J
  void reset() {
    dissipated_.reset();
    held_work_.reset();
  }

  /// Adds the powers at a state times `time` s.
  /// \param weight `time` times k_d, kg
  void add(const ChainKernels& kernels, const KernelChain& chain, const StateBuffer& state,
           double time, double weight) {
    if (held_work_.isNeeded()) held_work_.add(state, time);
    if (!track_dissipation_) return;
    dissipated_.addDrag(chain, state, time);
    if (chain.spring.damping == 0.0) return;
    kernels.addDissipation(chain, state.data(), weight, dissipated_.data());
  }

 private:
  bool track_dissipation_;
  DissipatedEnergy dissipated_;
  HeldWork held_work_;
};

}  // namespace spring_pendulum

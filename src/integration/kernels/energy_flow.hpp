// The energy that a chain loses and receives, integrated along with its motion. Each spring has its own
// sum over time, so the result does not depend on blocks, threads or instruction sets.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/state_buffer.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace spring_pendulum {

/// Dissipated energy of each spring, J, as an aligned column for the kernels.
class DissipatedEnergy {
 public:
  DissipatedEnergy() = default;
  explicit DissipatedEnergy(const Chain& chain)
      : springs_(chain.size() - 1),
        air_drag_(chain.airDrag()),
        numbers_(StateBuffer::pitchFor(chain.size())) {}

  double* data() { return numbers_.data(); }
  void reset() {
    std::fill_n(numbers_.data(), springs_, 0.0);
    air_ = 0.0;
  }

  /// Adds what the air dissipates at the velocities of a state in `time` s.
  void addDrag(const KernelChain& chain, const StateBuffer& state, double time) {
    if (air_drag_ == 0.0) return;
    double sum = 0.0;
    for (Eigen::Index i = 0; i < springs_; ++i) {
      const double* velocity = state.particle(i + 1) + 2 * state.pitch();
      const double square =
          velocity[0] * velocity[0] + velocity[state.pitch()] * velocity[state.pitch()];
      if (chain.drag_rates[i] != 0.0) sum += square;  // not held
    }
    air_ += time * air_drag_ * sum;
  }

  /// Sum over the springs first <= i < last, J.
  double sum(Eigen::Index first, Eigen::Index last) const {
    std::array<double, 8> sums{};
    for (Eigen::Index i = first; i < last; ++i) {
      sums[static_cast<std::size_t>((i - first) % 8)] += numbers_.data()[i];
    }
    return ((sums[0] + sums[4]) + (sums[1] + sums[5])) +
           ((sums[2] + sums[6]) + (sums[3] + sums[7]));
  }

  /// Sum over all springs and the air, J, always in the same order.
  double total() const {
    double total = air_;
    const Eigen::Index block = sumBlockSize(springs_);
    for (Eigen::Index first = 0; first < springs_; first += block) {
      total += sum(first, std::min(springs_, first + block));
    }
    return total;
  }

 private:
  Eigen::Index springs_ = 0;
  double air_drag_ = 0.0;  ///< N·s/m
  AlignedNumbers numbers_;
  double air_ = 0.0;  ///< J
};

/// Sums the work of holders and applied forces. Free of cost for a chain that is not driven.
class HeldWork {
 public:
  explicit HeldWork(const Chain& chain) : spring_(chain.spring()), forces_(chain.drive().forces) {
    for (Eigen::Index i = 0; chain.isDriven() && i < chain.size(); ++i) {
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
      if (i > 0) add_spring(-1);
      if (i + 1 < state.size()) add_spring(1);
    }
    for (const auto& [particle, force] : forces_) {
      const double* velocity = state.particle(particle) + 2 * pitch;
      power += force.x * velocity[0] + force.y * velocity[pitch];
    }
    work_ += time * power;
  }

 private:
  SpringLaw spring_;
  std::vector<AppliedForce> forces_;
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

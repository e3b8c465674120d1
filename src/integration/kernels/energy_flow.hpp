// The energy that a chain loses and receives, integrated along with its motion. Each spring has its own
// sum over time, so the result does not depend on blocks, threads or instruction sets.
#pragma once

#include "integration/kernels/chain_kernels.hpp"
#include "integration/kernels/kernel_data.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace spring_pendulum {

/// Sums the dissipated energy, if that is tracked, and the work of holders and applied forces.
class EnergyFlow {
 public:
  /// The tension of a spring, N, if the method solves for it; see DenseOutputStepper::tensionAt.
  using Tension = std::function<std::optional<double>(Eigen::Index spring)>;

  EnergyFlow(const Chain& chain, bool track_dissipation)
      : springs_(track_dissipation ? chain.size() - 1 : 0),
        air_drag_(chain.airDrag()),
        spring_(chain.spring()),
        forces_(chain.drive().forces) {
    if (track_dissipation) dissipated_ = AlignedNumbers(StateBuffer::pitchFor(chain.size()));
    for (Eigen::Index i = 0; chain.isDriven() && i < chain.size(); ++i)
      if (chain.isHeld(i)) held_.push_back(i);
  }

  bool isNeeded() const { return dissipated_.data() != nullptr || !held_.empty(); }
  /// Dissipated energy of each spring, J, as an aligned column for the kernels; null if not tracked.
  double* ofSprings() { return dissipated_.data(); }
  void reset() {
    std::fill_n(dissipated_.data(), springs_, 0.0);
    air_ = supplied_ = 0.0;
  }

  /// Sum over all springs and the air, J, always in the same order.
  double dissipated() const {
    double total = air_;
    const Eigen::Index block = sumBlockSize(springs_);
    for (Eigen::Index first = 0; first < springs_; first += block) {
      std::array<double, 8> sums{};
      for (Eigen::Index i = first; i < std::min(springs_, first + block); ++i)
        if (!isIdle(i)) sums[static_cast<std::size_t>((i - first) % 8)] += dissipated_.data()[i];
      total +=
          ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    }
    return total;
  }
  double supplied() const { return supplied_; }  ///< J

  void addSupplied(const StateBuffer& state, double time, const Tension& tension = {}) {
    if (!held_.empty()) supplied_ += time * suppliedPower(state, tension);
  }
  /// Adds the powers at a state times `time` s.
  /// \param weight `time` times k_d, kg
  void add(const ChainKernels& kernels, const KernelChain& chain, const StateBuffer& state,
           double time, double weight, const Tension& tension = {}) {
    addSupplied(state, time, tension);
    if (dissipated_.data() == nullptr) return;
    if (air_drag_ != 0.0) air_ += time * air_drag_ * squaredVelocities(chain, state);
    if (chain.spring.damping == 0.0) return;
    kernels.addDissipation(chain, state.data(), weight, dissipated_.data());
  }

 private:
  /// Whether both ends of a spring are held: it moves nothing, and has no energy. See computeEnergy.
  bool isIdle(Eigen::Index spring) const {
    const auto end = std::lower_bound(held_.begin(), held_.end(), spring);
    return held_.end() - end > 1 && end[0] == spring && end[1] == spring + 1;
  }

  /// Sum over the particles that are not held.
  double squaredVelocities(const KernelChain& chain, const StateBuffer& state) const {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < springs_; ++i) {
      const double* velocity = state.particle(i + 1) + 2 * state.pitch();
      const double square =
          velocity[0] * velocity[0] + velocity[state.pitch()] * velocity[state.pitch()];
      if (chain.drag_rates[i] != 0.0) sum += square;
    }
    return sum;
  }

  double suppliedPower(const StateBuffer& state, const Tension& tension) const {
    const Eigen::Index pitch = state.pitch();
    double power = 0.0;
    for (const Eigen::Index i : held_) {
      const double* z = state.particle(i);
      for (const Eigen::Index other : {-1, 1}) {
        const Eigen::Index spring = std::min(i, i + other);
        if (i + other < 0 || i + other >= state.size() || isIdle(spring)) continue;
        const auto difference = [&](Eigen::Index column) {
          return z[column * pitch + other] - z[column * pitch];
        };
        const PlaneVector<double> d{difference(0), difference(1)};
        const auto known = tension ? tension(spring) : std::nullopt;
        const double unit = known.value_or(0.0) * inverseLength(d);
        const PlaneVector<double> force =
            known ? PlaneVector<double>{unit * d.x, unit * d.y}
                  : springForce(spring_, d, {difference(2), difference(3)});
        power -= force.x * z[2 * pitch] + force.y * z[3 * pitch];
      }
    }
    for (const auto& [particle, force] : forces_) {
      const double* velocity = state.particle(particle) + 2 * pitch;
      power += force.x * velocity[0] + force.y * velocity[pitch];
    }
    return power;
  }

  Eigen::Index springs_;  ///< 0 if the dissipation is not tracked
  double air_drag_;       ///< N·s/m
  SpringLaw spring_;
  std::vector<AppliedForce> forces_;
  std::vector<Eigen::Index> held_;
  AlignedNumbers dissipated_;
  double air_ = 0.0;       ///< J
  double supplied_ = 0.0;  ///< J
};

}  // namespace spring_pendulum

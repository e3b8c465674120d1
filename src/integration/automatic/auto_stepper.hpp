// Auto: chooses the cheapest method for the chain, the tolerance and the current motion.
//
// The first method is a Taylor series method of order 8 or 12, depending on the tolerance. It is
// the cheapest while accuracy limits the step size. When the steps approach its stability limit
// (step * k_d μ without air, with the largest spring mode μ of the chain), the motion is stiff. The
// stabilised series of order 8 then replaces the plain series of order 8, as it needs no more work.
// Later, the methods race: the plain series, the stabilised series of order 4 and 8 and, for light
// particles or stiff springs, Radau-9. Each takes a few steps from the same state. The one that
// covers the most time per work wins, where work is measured in force evaluations of Taylor-8. The
// work of an evaluation is a constant for each method and no clock is read, so the choice and the
// bits are the same on every machine. A method is constructed when it is first used.
//
// Races take a few percent of the work. They continue while a stiff method is active, so Auto
// returns to the plain series when the motion is no longer stiff.
//
// Idea: L. Petzold, SIAM J. Sci. Stat. Comput. 4 (1983) 136-148, doi:10.1137/0904010.
#pragma once

#include "integration/error_control/dense_output_stepper.hpp"
#include <spring_pendulum/model/chain.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

class AutoStepper final : public DenseOutputStepper {
 public:
  AutoStepper(const Chain& chain, double tolerance);

  void start(const State& state) override;
  double step() override;
  const StateBuffer& stateAt(double fraction) const override {
    return active().stepper->stateAt(fraction);
  }
  std::optional<double> tensionAt(Eigen::Index spring, double fraction) const override {
    return active().stepper->tensionAt(spring, fraction);
  }
  StepStatistics statistics() const override;
  double workPerEvaluation() const override;

  /// "Taylor-8 for 40 steps, Stabilized-Taylor-8 for 46 steps, 1 switch"
  std::string report() const override;

  std::string_view method() const { return active().name; }

 private:
  struct Candidate {
    std::string_view name;
    double work_per_evaluation;  ///< in force evaluations of Taylor-8
    std::unique_ptr<DenseOutputStepper> (*make)(const Chain& chain, double tolerance);
    std::unique_ptr<DenseOutputStepper> stepper{};  ///< constructed when used
    std::int64_t steps = 0;                         ///< accepted while it was active
    std::int64_t earlier = 0;                       ///< evaluations of released steppers
    double races_from = 0.0;  ///< least `work_` for a race; 0: takes part in each
    int warming_up = 6;       ///< steps in a race that find its step size
  };
  /// Simulated time and the work spent on it.
  struct Pace {
    double time = 0.0;  ///< s
    double work = 0.0;  ///< in force evaluations of Taylor-8
    bool isFasterThan(const Pace& other, double factor) const {
      return time * other.work > factor * other.time * work;
    }
  };

  const Candidate& active() const { return candidates_[active_]; }
  static std::int64_t evaluationsOf(const Candidate& candidate);
  static double workSince(const Candidate& candidate, std::int64_t evaluations_before);
  Pace paceOf(Candidate& candidate, const State& state);
  bool isStiff() const;
  /// Whether the work since the last race suffices for another. Otherwise begins a new measurement of
  /// the pace if one has finished.
  bool isTimeForRace();
  DenseOutputStepper& startedAt(Candidate& candidate, const State& state);
  /// Frees the memory of a candidate that is not active, if the chain is long.
  void release(Candidate& candidate);
  /// Sets `state_` to the end of the last step.
  void readState();
  void race();
  /// Continues from `state_` with candidate `to`.
  void change(std::size_t to);

  Chain chain_;
  double tolerance_;
  double fastest_rate_;               ///< largest damping rate, 1/s
  bool vibrates_fast_;                ///< see kFastVibration
  bool successor_is_better_ = false;  ///< candidate 1 beats candidate 0 in stiff motion
  double explicit_limit_ = 0.0;       ///< stability limit h|λ| of candidate 0
  std::vector<Candidate> candidates_;
  std::size_t active_ = 0;
  Pace recent_;  ///< latest pace of the active method
  Pace raced_;   ///< pace with which it won the last race
  std::int64_t recent_steps_ = 0;
  double race_work_ = 0.0;   ///< of the last race
  double work_ = 0.0;        ///< since the start, without races
  double races_from_ = 0.0;  ///< least `work_` for the next race
  int switches_ = 0;
  double last_step_ = 0.0;
  State state_;
};

}  // namespace spring_pendulum

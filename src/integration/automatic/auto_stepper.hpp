// Auto: takes the method that is cheapest for the chain, the tolerance and the motion at hand.
//
// It begins with a Taylor series method, of order 8 or 12 by tolerance, the cheapest as long as
// accuracy limits its steps. When they come near its stability limit (step * k_d μ, with the
// chain's largest spring mode μ), the motion has turned stiff. The stabilised series of order 8 then
// takes over from the plain one of order 8, as it needs no more work. After that the methods race:
// the plain series, the stabilised ones of order 4 and 8 and, for light particles, Radau-9.
// Each takes a few steps from the same state, and what counts is the time it covers per work, in
// force evaluations of Taylor-8. All control their error alike: long steps each, and short steps
// per unit of time. The work of a method's evaluation is a constant, no clock is read, so every
// machine chooses alike and the bits stay the same. A method is made when it is first needed.
//
// Races are held rarely enough to cost some percents of the work, and a challenger has to be
// better by a fifth, so that two methods that are equally good do not take turns. Races go on while
// a stiff method is at work, so it is left again when the motion stops being stiff.
//
// A method for a million particles takes about a gigabyte: for long chains, only the method at work
// and one challenger exist at a time.
//
// Reference for the idea: L. Petzold, SIAM J. Sci. Stat. Comput. 4 (1983) 136-148,
// doi:10.1137/0904010.
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
  /// The longest chain for which methods that are not at work are kept; making one anew costs less
  /// than its first step, but asks for memory.
  static constexpr Eigen::Index kKeepsUpTo = 10'000;

  AutoStepper(const Chain& chain, double tolerance, Eigen::Index keeps_up_to = kKeepsUpTo);

  void start(const State& state) override;
  double step() override;
  void interpolate(double fraction, State& state) const override {
    active().stepper->interpolate(fraction, state);
  }
  StepStatistics statistics() const override;

  /// "Taylor-8 for 0.4 s, Stabilized-Taylor-8 for 4.6 s, 1 switch"
  std::string report() const override;

  /// The method at work.
  std::string_view method() const { return active().name; }

 private:
  struct Candidate {
    std::string_view name;
    double work_per_evaluation;  ///< in force evaluations of Taylor-8
    std::unique_ptr<DenseOutputStepper> (*make)(const Chain& chain, double tolerance);
    std::unique_ptr<DenseOutputStepper> stepper{};  ///< made when it is used
    double covered = 0.0;                           ///< time integrated with it, s
    std::int64_t earlier_evaluations = 0;           ///< of steppers that were given up
    std::int64_t earlier_rejected = 0;
  };
  /// Time covered and the work it took.
  struct Pace {
    double time = 0.0;
    double work = 0.0;
    bool isFasterThan(const Pace& other) const;
  };

  const Candidate& active() const { return candidates_[active_]; }
  static std::int64_t evaluationsOf(const Candidate& candidate) {
    return candidate.earlier_evaluations +
           (candidate.stepper ? candidate.stepper->statistics().force_evaluations : 0);
  }
  static double workSince(const Candidate& candidate, std::int64_t evaluations);
  Pace paceOf(Candidate& candidate, const State& state);
  bool isStiff() const;
  DenseOutputStepper& startedAt(Candidate& candidate, const State& state);
  /// Gives up the memory of a candidate that is not at work, if the chain is long.
  void release(Candidate& candidate);
  /// `state_` becomes the end of the last step.
  void readState();
  void race();
  /// Goes on from `state_` with another candidate, or with the same one.
  void change(std::size_t to);

  Chain chain_;
  double tolerance_;
  Eigen::Index keeps_up_to_;
  double fastest_rate_;               ///< of the damped modes, 1/s
  bool successor_is_better_ = false;  ///< candidate 1 than the first, if the motion is stiff
  double explicit_limit_ = 0.0;       ///< h|λ| up to which the first candidate is stable
  std::vector<Candidate> candidates_;
  std::size_t active_ = 0;
  Pace recent_;  ///< of the active method since it began or since the last race
  std::int64_t recent_steps_ = 0;
  double work_before_race_ = 0.0;
  std::int64_t steps_ = 0;
  int switches_ = 0;
  double last_step_ = 0.0;
  State state_;
};

}  // namespace spring_pendulum

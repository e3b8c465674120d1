// One run of a scene: the simulation loop of every program.
//
//     Run run(scene, plan);
//     while (run.advance()) show(run.state());
//     print(run.closingLine());
//
// A run owns the chain, its state, the integrator, the judge and the reference run, and keeps the time. It knows no
// file and no ROS. Judging happens at frames only, so what a run says about itself depends neither on
// the display rate nor on the number of threads.
#pragma once

#include <spring_pendulum/integration/integrator.hpp>
#include <spring_pendulum/model/chain.hpp>
#include <spring_pendulum/model/energy.hpp>
#include <spring_pendulum/model/scene.hpp>
#include <spring_pendulum/model/state.hpp>
#include <spring_pendulum/simulation/plan.hpp>
#include <spring_pendulum/simulation/verdict.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#pragma GCC visibility push(default)
namespace spring_pendulum {

class Judge;
class ReferenceRun;

struct RunOptions {
  /// Integrate the dissipated energy even if that takes more than about 50 ms and 10 % of the run.
  bool track_dissipation = false;
  /// Simulated time in s between the states of `advancePart`; 0: only at frames. The parts of a frame are
  /// whole steps, or 2^q output intervals of an error-controlled method. No bit of the frames changes.
  double display_interval = 0.0;
  /// Asked every 20 ms of computing. If it returns true or throws, the run ends here. It must not change the run.
  std::function<bool()> stop = {};
  /// If false, `Run::seconds` is 0. Reading the clock takes some 3 % of a run of ten particles.
  bool measure_seconds = true;
};

class Run {
 public:
  /// \throws InputError for a value out of its range, a tolerance below the rounding errors of the
  ///   positions, an initial energy beyond the range of double, or a frame of the scene that the plan
  ///   does not have
  /// \throws std::runtime_error if the run is expected to need more memory than there is
  Run(const Scene& scene, const Plan& plan, const RunOptions& options = {});
  Run(Run&&) noexcept;
  ~Run();

  /// Advances to the next frame and judges it. The first call stays at the start.
  /// \returns whether this frame may be shown and written. If not, the run is over: the last frame
  ///   was reached before, the motion has diverged, or `RunOptions::stop` has stopped the run.
  bool advance() { return advanceTo(parts_); }

  /// Like `advance`, but stops at the end of the next part of the frame; see `RunOptions::display_interval`.
  bool advancePart() { return advanceTo(part_ + 1); }

  /// Returns to the start, as before the first call of `advance`, and discards the verdict. The closing
  /// line counts the work of all rounds. Changed constants and the drive stay.
  void reset() { goTo(first_frame_, start_); }

  /// Goes to a frame and a state at it, as if the run had started there: energies, errors and verdict
  /// are relative to it until a reset. Changed constants and the drive stay.
  /// \throws InputError if the plan has no such frame or the chain cannot have the state
  void goTo(std::int64_t frame, const State& state);

  /// Continues from another state, with other constants and another drive. The energy balance counts
  /// the difference of the energies before and after as supplied. The reference run ends.
  /// \param plan  its method and tolerance replace those of the run; the frame interval stays
  /// \param state the current one, or one that differs from it
  /// \throws InputError for a value out of its range, a drive or a state that the chain cannot have,
  ///   and a change between fixed steps and error control inside a frame; nothing has changed then
  void change(const Plan& plan, const Constants& constants, const Drive& drive, const State& state);

  /// Whether no frame follows.
  bool isOver() const { return stopped_ || frame_ >= plan_.frames - 1 || !isShown(); }
  bool wasStopped() const { return stopped_; }  ///< by `RunOptions::stop`; only `reset` may follow
  /// Whether the current frame may be shown: yes unless the motion has diverged; after a divergence
  /// only if `Plan::on_divergence` is `kContinue` and the energy is finite.
  bool isShown() const;
  bool isAtFrame() const { return part_ == 0; }  ///< whether the current state is that of a frame
  bool isFinite() const { return state_.values().allFinite(); }  ///< every number of the state

  const Plan& plan() const { return plan_; }
  const Chain& chain() const { return chain_; }
  const Integrator& integrator() const { return *integrator_; }  ///< `change` replaces it
  const State& start() const { return start_; }
  /// The frame of the start, to which energies and errors are relative: 0, or that of the saved state.
  std::int64_t firstFrame() const { return first_frame_; }
  const State& state() const { return state_; }
  std::int64_t frame() const { return frame_; }  ///< the last that was reached, counted from 0
  std::int64_t shownFrames() const { return totals_.frames; }  ///< over all rounds
  double seconds() const { return totals_.seconds; }  ///< wall-clock, without the reference run
  double time() const { return timeOfPart(part_); }   ///< simulated, s
  double nextTime() const { return timeOfPart(part_ + 1); }    ///< after `advancePart`, s
  double nextFrameTime() const { return timeOfPart(parts_); }  ///< of the next frame, s
  bool isChanged() const { return changed_; }  ///< by `change`, since the start or the last reset

  const Verdict& verdict() const;       ///< on the run so far
  EnergyEntry energyEntry() const;      ///< the energy balance of the current state
  double largestEnergyError() const;    ///< so far, in energy scales; NaN if it is unknown
  PositionError positionError() const;  ///< now, and the largest at the frames so far
  double referenceWork() const;         ///< of the reference run so far, s, see Integrator::work
  const State* referenceState() const;  ///< that of the reference run; null if it is unknown

  /// One line: work, times, what was measured, verdict.
  /// \param output put after the time of integrating: ", 3.07 ms writing to /home/me/frames"
  std::string closingLine(const std::string& output = "") const;
  /// What was measured: "largest position error 0.00024 m at t = 9.8 s, energy balance not checked".
  std::string measurements() const;
  /// A line if the position error of an error-controlled method may exceed ten tolerances; else empty.
  std::string toleranceRemark() const;

 private:
  /// Numbers for the closing line, over all rounds.
  struct Totals {
    std::int64_t frames = 0;                        ///< shown
    std::int64_t slept_frames = 0;                  ///< of these
    std::int64_t steps = 0;                         ///< of fixed size
    double seconds = 0.0, reference_seconds = 0.0;  ///< wall-clock time spent integrating
  };

  void begin(std::int64_t frame, const State& state);
  void checkState(const State& state) const;
  void divideFrames();
  bool isJudged() const { return isAtFrame() && !changed_; }  // a change makes the entry stale
  static std::unique_ptr<Integrator> integratorOf(const Plan&, const Chain&, bool tracks);
  bool advanceTo(std::int64_t part);
  bool integrate(std::int64_t steps);
  bool advanceReference(std::int64_t steps);
  bool sleeps();
  void judgeFrame(double work = 0.0);
  std::int64_t stepOfPart(std::int64_t part) const;
  double timeOfPart(std::int64_t part) const;

  Plan plan_;
  RunOptions options_;
  Chain chain_;
  State start_;
  std::int64_t first_frame_;
  State state_;
  std::unique_ptr<Integrator> integrator_;
  double step_;             ///< s; shorter than that of the plan for an error-controlled method
  std::int64_t steps_;      ///< per frame
  std::int64_t parts_ = 1;  ///< per frame
  bool track_dissipation_;
  std::unique_ptr<Judge> judge_;
  std::unique_ptr<ReferenceRun> reference_;  ///< null: none
  bool started_ = false;    ///< whether `advance` was called since the start or a reset
  std::int64_t frame_ = 0;  ///< last frame
  std::int64_t part_ = 0;   ///< completed parts of the next frame
  bool stopped_ = false;
  bool asleep_ = false;
  bool changed_ = false;                 ///< since construction or the last reset
  double dissipated_before_ = 0.0;       ///< J, before the current integrator started
  double dissipated_ = 0.0;              ///< J, until the current state
  double supplied_before_ = 0.0;         ///< J, as above
  double supplied_ = 0.0;                ///< J
  std::int64_t evaluations_before_ = 0;  ///< by earlier integrators
  double work_at_start_ = 0.0;           ///< of the integrator, s
  Totals totals_;
};

}  // namespace spring_pendulum
#pragma GCC visibility pop

// The verdict on a motion: may what was computed be believed?
//
// A chain that nothing drives never gains energy, whatever its damping, so energy above the start
// proves an unstable or inaccurate integration even while every number stays finite. Judged after
// every frame, before it is written.
#pragma once

#include <spring_pendulum/simulation/energy_balance.hpp>

#include <string>
#include <string_view>

namespace spring_pendulum {

/// In order of severity.
enum class VerdictKind {
  kOk,
  kDrift,         ///< the energy balance's residual exceeds 1 % of the energy scale
  kGainedEnergy,  ///< energy above the start by over 1 % of the energy scale
  kDiverged       ///< a number that is not finite, or energy up by over the whole scale
};

/// "ok", "drift", "gained energy", "diverged"
std::string_view toString(VerdictKind kind);

struct Verdict {
  VerdictKind kind = VerdictKind::kOk;
  double time = 0.0;          ///< s, of the frame judged
  Eigen::Index particle = 0;  ///< diverged: the particle to blame, counted from 1; else 0
  std::string text = "ok";    ///< one line: what is wrong, when and where
};

/// Judges the frames of one run and remembers the worst.
class Judge {
 public:
  static constexpr double kDriftThreshold = 0.01;
  static constexpr double kGainThreshold = 0.01;
  static constexpr double kDivergenceThreshold = 1.0;

  /// \throws InputError as EnergyBalance
  Judge(const Chain& chain, const State& start, bool tracks_dissipation);

  /// Judges the state at `time` s. No allocation while the motion is good.
  /// \param dissipated `Integrator::dissipatedEnergy()`, J; read only if it is tracked
  const Verdict& judge(double time, const State& state, double dissipated);

  /// The energy balance's row of the state judged last.
  const EnergyEntry& entry() const { return entry_; }
  /// The verdict on the state judged last.
  const Verdict& latest() const { return latest_; }
  /// The first of the most severe verdicts so far: the verdict on the run.
  const Verdict& worst() const { return worst_; }

 private:
  Chain chain_;
  EnergyBalance energy_balance_;
  EnergyEntry entry_;
  Verdict latest_;
  Verdict worst_;
};

}  // namespace spring_pendulum

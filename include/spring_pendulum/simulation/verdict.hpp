// The verdict on a run: can its result be trusted?
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#pragma GCC visibility push(default)
namespace spring_pendulum {

/// In order of severity.
enum class VerdictKind {
  kOk,
  kNotChecked,    ///< the position error was not measured, or not to the end
  kSensitive,     ///< perturbations grow so much that the true positions are unknown
  kInaccurate,    ///< position error above 1 % of the chain's length
  kDrift,         ///< residual of the energy balance above 1 % of the energy scale
  kGainedEnergy,  ///< energy gain above 1 % of the energy scale
  kDiverged       ///< a number is not finite, or energy gain above the energy scale
};

/// "ok", "not checked", "sensitive", "inaccurate", "drift", "gained energy", "diverged"
std::string_view toString(VerdictKind kind);

/// Whether the result of the run is wrong: `kInaccurate` and worse.
inline bool isBad(VerdictKind kind) {
  return kind >= VerdictKind::kInaccurate;
}

struct Verdict {
  VerdictKind kind = VerdictKind::kOk;
  double time = 0.0;            ///< time of the judged frame, s
  std::ptrdiff_t particle = 0;  ///< first particle to diverge, counted from 1; else 0
  std::string text = "ok";      ///< one line: what is wrong, when and where
};

/// Position errors: the largest distance of a particle from where the reference run has it; NaN: unknown.
struct PositionError {
  double now = std::numeric_limits<double>::quiet_NaN();           ///< m, at the last frame
  double uncertainty = std::numeric_limits<double>::quiet_NaN();   ///< m, of `now`
  double largest = std::numeric_limits<double>::quiet_NaN();       ///< m, over the frames so far
  double largest_time = std::numeric_limits<double>::quiet_NaN();  ///< s
  double bound = std::numeric_limits<double>::quiet_NaN();  ///< m, largest sum with uncertainty
  double measured_until = std::numeric_limits<double>::quiet_NaN();  ///< s

  /// Whether `largest` is known within a factor of 2. Else only `bound` is known.
  bool isResolved() const { return bound <= 1.5 * largest; }
};

}  // namespace spring_pendulum
#pragma GCC visibility pop

// The verdict on a run without output, and a loop over methods with a fixed step.
#pragma once

#include "simulation/judge.hpp"
#include <spring_pendulum/integration/method_table.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "support/scenes.hpp"

namespace spring_pendulum::test {

/// Judges a run of `duration` s with a fixed step every 0.1 s, or every step if the step is longer. Ends when the
/// verdict is `enough` or worse. Returns `kOk` unless the energy is at fault, with `with_energy` also if it drifts.
inline Verdict verdictOfRun(const Scene& scene, const Method& method, double time_step,
                            double duration, bool with_energy,
                            VerdictKind enough = VerdictKind::kDiverged) {
  const auto integrator = makeIntegrator(method, scene.chain, {1e-6, with_energy});
  State state = scene.start;
  Judge judge(scene.chain, state,
              JudgeOptions{with_energy, method.symplectic ? time_step : 0.0, 0.0,
                           method.symplectic ? method.order : 0});
  judge.judge(0.0, state, 0.0, nullptr);  // as every run does
  const std::int64_t steps =
      std::max<std::int64_t>(1, std::llround(std::min(0.1, duration) / time_step));
  for (std::int64_t n = 0; static_cast<double>(n) * time_step < duration; n += steps) {
    integrator->advance(state, time_step, steps);
    const double time = static_cast<double>(n + steps) * time_step;
    if (judge.judge(time, state, integrator->dissipatedEnergy(), nullptr).kind >= enough) break;
  }
  // Positions are not measured here.
  return judge.worst().kind == VerdictKind::kNotChecked ? Verdict{} : judge.worst();
}

template <typename Visitor>
void forEachFixedStepMethod(const Visitor& visitor) {
  for (const Method& method : methodTable()) {
    if (!method.hasFixedStep()) continue;
    SCOPED_TRACE(method.name);
    visitor(method);
  }
}

}  // namespace spring_pendulum::test

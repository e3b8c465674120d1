// What a run says about itself.
#include "base/numbers.hpp"
#include <spring_pendulum/simulation/run.hpp>

#include <fmt/format.h>

namespace spring_pendulum {

std::string Run::closingLine(const Integrator& integrator, const std::string& output) const {
  const Method& method = scenario_.method;
  const std::string report = integrator.report();
  return fmt::format(
      "{}{}: {}, {}{}, {}{}, {} integrating{}, {} reference run, {}, verdict: {}", method.name,
      report.empty() ? "" : " (" + report + ")", counted(chain_.size(), "particle"),
      counted(totals_.frames, "frame"),
      totals_.slept_frames > 0 ? fmt::format(" ({} at rest, not integrated)", totals_.slept_frames)
                               : "",
      method.hasFixedStep() ? counted(totals_.integrated_frames * frame_steps_.steps, "step") + ", "
                            : "",
      counted(evaluations_before_ + integrator.forceEvaluations(), "force evaluation"),
      durationText(totals_.seconds), output, durationText(totals_.reference_seconds),
      measurements(), toString(verdict().kind));
}

}  // namespace spring_pendulum

#include "simulation/expected_cost.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/simulation/outcome.hpp>
#include <spring_pendulum/simulation/stability_advice.hpp>

#include <utility>

namespace spring_pendulum {

Remarks remarksOn(const Run& run) {
  Remarks remarks;
  for (const std::string& note :
       {memoryRemark(run.plan(), run.chain().size()), remarkOn(run.chain().constants())}) {
    if (!note.empty()) remarks.notes.push_back(note);
  }
  remarks.warning = stabilityWarning(run.chain(), run.start(), run.plan());
  return remarks;
}

Outcome outcomeOf(const Run& run, const std::function<bool()>& stop) {
  const Verdict& verdict = run.verdict();
  if (verdict.kind == VerdictKind::kDiverged) {
    const std::string remedy =
        run.isChanged() ? "hands, forces or changes have driven the run"
                        : remedyForDivergence(run.chain(), run.start(), run.plan(), stop);
    return {3, {verdict.text + (remedy.empty() ? "" : "; " + remedy)}};
  }
  Outcome outcome;
  if (isBad(verdict.kind) || verdict.kind == VerdictKind::kSensitive)
    outcome.lines.push_back(verdict.text);
  if (std::string remark = run.toleranceRemark(); !remark.empty())
    outcome.lines.push_back(std::move(remark));
  return outcome;
}

}  // namespace spring_pendulum

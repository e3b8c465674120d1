#include "check/mistake_search.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "check/program_fit.hpp"

namespace spring_pendulum {
namespace {

/// Significant digits of fitted constants.
constexpr int kMostDigits = 15;

/// Numbers with as many digits tell whether they are floats.
constexpr int kDigitsOfFloat = 9;

using Kind = Constant::Kind;

bool isSinglePrecision(const Mistake& mistake) {
  return mistake.name == "single_precision";
}

/// Whether a constant belongs to the method, not to the model.
bool isCoefficient(const Constant& constant) {
  return constant.kind == Kind::kWeight || constant.kind == Kind::kFraction;
}

std::vector<const Constant*> weightsOf(const StudentProgram& program) {
  std::vector<const Constant*> weights;
  for (const Constant& constant : fittedConstants()) {
    if (constant.kind == Kind::kWeight && concerns(constant.stages, program))
      weights.push_back(&constant);
  }
  return weights;
}

/// The sentence on a fitted constant: "uses g = 10 m/s² instead of 9.81".
std::string sentenceOn(const Constant& constant, double value, double right) {
  std::string sentence(constant.sentence);
  sentence.replace(sentence.find("{}"), 2, roundedText(value, kMostDigits));
  return fmt::format("{} instead of {}", sentence, roundedText(right, 6));
}

}  // namespace

struct MistakeSearch::Candidate {
  StudentProgram program;
  Explanation explanation;

  void make(const Mistake& mistake) {
    mistake.make(program);
    add(mistake.name, std::string(mistake.sentence));
  }
  void makeSinglePrecision() {
    for (const Mistake& mistake : knownMistakes())
      if (isSinglePrecision(mistake)) make(mistake);
  }
  void add(std::string_view name, std::string sentence) {
    if (explanation.mistakes.empty() || explanation.mistakes.back() != name)
      explanation.mistakes.emplace_back(name);
    explanation.sentences.push_back(std::move(sentence));
  }
};

MistakeSearch::MistakeSearch(const Scenario& scenario, const Particles& particles,
                             const AllFrames& frames, std::size_t known_frames, WorkLimit limit)
    : scenario_(scenario),
      particles_(particles),
      frames_(frames),
      known_frames_(known_frames),
      limit_(std::move(limit)) {}

std::vector<Explanation> MistakeSearch::singleMistakes(const Method& method) {
  found_.clear();
  tryMistakes(rightProgram(method));
  found_.erase(std::remove_if(found_.begin(), found_.end(),
                              [&](const Explanation& one) { return !isStrong(one); }),
               found_.end());
  return found_;
}

std::vector<Explanation> MistakeSearch::search(
    const std::vector<std::vector<const Method*>>& methods) {
  // The simplest first: numbers of many candidates fit few digits, whatever the mistake is.
  constexpr Level kLevels[] = {&MistakeSearch::tryMistakes,
                               &MistakeSearch::tryConstants,
                               &MistakeSearch::trySinglePrecision,
                               &MistakeSearch::tryTwoMistakes,
                               &MistakeSearch::tryMistakeAndConstant,
                               &MistakeSearch::tryCoefficients,
                               &MistakeSearch::tryWeights,
                               &MistakeSearch::trySinglePrecisionAndMistake,
                               &MistakeSearch::tryMistakeAndCoefficient,
                               &MistakeSearch::tryMistakeAndWeights};
  found_.clear();
  std::vector<Explanation> best;
  for (const Level level : kLevels) {
    for (const std::vector<const Method*>& group : methods) {
      for (const Method* method : group) (this->*level)(rightProgram(*method));
      if (found_.empty()) continue;
      const auto reach = [](const Explanation& a, const Explanation& b) {
        return a.last_frame > b.last_frame;
      };
      std::stable_sort(found_.begin(), found_.end(), reach);
      // A motion that explodes soon agrees with few frames; it must not hide a better explanation.
      const Explanation& longest = found_.front();
      const bool is_likely = isStrong(longest) || longest.mistakes.size() == 1;
      const bool is_better = best.empty() || longest.last_frame > 2 * best.front().last_frame;
      if (is_likely && is_better) best = found_;
      found_.clear();
      if (!best.empty() && isStrong(best.front())) return best;
    }
  }
  return best;
}

bool MistakeSearch::isStrong(const Explanation& explanation) const {
  constexpr std::size_t kEvidence = 20;  // frames after the departure
  const std::size_t last = std::min(known_frames_ + kEvidence, frames_.frames.size() - 1);
  return explanation.last_frame >= frames_.frames[last].index;
}

MistakeSearch::Candidate MistakeSearch::rightProgram(const Method& method) const {
  Candidate candidate{StudentProgram(*method.tableau, scenario_), {method.name, {}, {}, 0}};
  if (frames_.single_precision) candidate.makeSinglePrecision();
  return candidate;
}

bool MistakeSearch::isOver() {
  gave_up_ |= limit_.isOver();
  return gave_up_;
}

template <typename Function>
void MistakeSearch::tryWithMistakes(const Candidate& base, const Function& try_one) {
  for (const Mistake& mistake : knownMistakes()) {
    if (!concerns(mistake.stages, base.program) || isSinglePrecision(mistake) || isOver()) continue;
    Candidate candidate = base;
    candidate.make(mistake);
    try_one(candidate);
  }
}

void MistakeSearch::tryMistakes(const Candidate& base) {
  if (frames_.single_precision && explains(base)) return;
  tryWithMistakes(base, [&](const Candidate& candidate) { explains(candidate); });
}

void MistakeSearch::tryConstants(const Candidate& base) {
  constexpr double kFactors[] = {1.0, 0.1, 10.0, -1.0};
  for (const Constant& constant : fittedConstants()) {
    if (isCoefficient(constant)) continue;
    for (const double factor : kFactors) {
      if (isOver() || fit(base, {&constant}, factor)) break;
    }
  }
}

void MistakeSearch::trySinglePrecision(const Candidate& base) {
  if (frames_.single_precision || frames_.digits >= kDigitsOfFloat) return;
  Candidate candidate = base;
  candidate.makeSinglePrecision();
  explains(candidate);
}

void MistakeSearch::tryTwoMistakes(const Candidate& base) {
  const std::vector<Mistake>& table = knownMistakes();
  for (std::size_t first = 0; first < table.size(); ++first) {
    if (!concerns(table[first].stages, base.program) || isSinglePrecision(table[first])) continue;
    for (std::size_t second = first + 1; second < table.size(); ++second) {
      if (!concerns(table[second].stages, base.program) || isSinglePrecision(table[second]) ||
          table[first].name == table[second].name || isOver()) {
        continue;
      }
      Candidate candidate = base;
      candidate.make(table[first]);
      candidate.make(table[second]);
      explains(candidate);
    }
  }
}

void MistakeSearch::tryMistakeAndConstant(const Candidate& base) {
  const std::vector<Constant>& constants = fittedConstants();
  for (const Constant& constant : constants) {
    if (isCoefficient(constant)) continue;
    tryWithMistakes(base, [&](const Candidate& candidate) { fit(candidate, {&constant}, 1.0); });
  }
  for (std::size_t first = 0; found_.empty() && first < constants.size(); ++first) {
    for (std::size_t second = first + 1; second < constants.size(); ++second) {
      if (isCoefficient(constants[first]) || isCoefficient(constants[second]) || isOver()) continue;
      fit(base, {&constants[first], &constants[second]}, 1.0);
    }
  }
}

void MistakeSearch::tryCoefficients(const Candidate& base) {
  for (const Constant& constant : fittedConstants()) {
    if (!isCoefficient(constant) || !concerns(constant.stages, base.program) || isOver()) continue;
    fit(base, {&constant}, 1.0);
  }
}

void MistakeSearch::tryMistakeAndCoefficient(const Candidate& base) {
  if (base.program.tableau.stages == 1) return;  // the weight of Euler is a time step
  tryWithMistakes(base, [&](const Candidate& candidate) { tryCoefficients(candidate); });
  for (const Constant& first : fittedConstants()) {
    for (const Constant& second : fittedConstants()) {
      if (isCoefficient(first) || !isCoefficient(second) || isOver()) continue;
      if (concerns(second.stages, base.program)) fit(base, {&first, &second}, 1.0);
    }
  }
}

void MistakeSearch::tryWeights(const Candidate& base) {
  const std::vector<const Constant*> weights = weightsOf(base.program);
  if (weights.size() > 1 && !isOver()) fit(base, weights, 1.0);
}

void MistakeSearch::tryMistakeAndWeights(const Candidate& base) {
  tryWithMistakes(base, [&](const Candidate& candidate) { tryWeights(candidate); });
  std::vector<const Constant*> constants = weightsOf(base.program);
  if (constants.size() == 1) return;
  for (const Constant& constant : fittedConstants()) {
    if (constant.kind != Kind::kModel || isOver()) continue;
    constants.insert(constants.begin(), &constant);
    fit(base, constants, 1.0);
    constants.erase(constants.begin());
  }
}

void MistakeSearch::trySinglePrecisionAndMistake(const Candidate& base) {
  if (frames_.single_precision || frames_.digits >= kDigitsOfFloat) return;
  Candidate candidate = base;
  candidate.makeSinglePrecision();
  tryMistakes(candidate);
  if (found_.empty()) tryConstants(candidate);
}

Agreement MistakeSearch::agreementOf(const Candidate& candidate) {
  return compare(
      frames_, [&] { return motionOf(candidate.program, particles_); }, limit_);
}

bool MistakeSearch::isConvincing(const Agreement& agreement) {
  return agreement.complete && agreement.frames > known_frames_ && !isOver();
}

bool MistakeSearch::explains(const Candidate& candidate) {
  const Agreement agreement = agreementOf(candidate);
  if (!isConvincing(agreement)) return false;
  keep(candidate, agreement.last_frame);
  return true;
}

void MistakeSearch::keep(const Candidate& candidate, std::int64_t last_frame) {
  found_.push_back(candidate.explanation);
  found_.back().last_frame = last_frame;
}

bool MistakeSearch::fit(Candidate candidate, const std::vector<const Constant*>& constants,
                        double factor) {
  StudentProgram start = candidate.program;
  const std::size_t mistakes = candidate.explanation.sentences.size();
  for (const Constant* constant : constants) constant->of(candidate.program) *= factor;
  Agreement agreement = agreementOf(candidate);
  while (!agreement.complete && !isOver()) {
    const std::size_t window =
        std::min(frames_.frames.size(), agreement.frames + agreement.frames / 2 + 2);
    fitConstants(candidate.program, constants, frames_, window, particles_, limit_);
    const std::size_t before = agreement.frames;
    agreement = agreementOf(candidate);
    if (!agreement.complete && agreement.frames <= before) return false;
  }
  if (!isConvincing(agreement)) return false;
  roundConstants(candidate, constants);
  for (const Constant* constant : constants) {
    // Smaller changes are rounding errors, in few digits those of float.
    const double smallest_mistake = frames_.digits < kDigitsOfFloat ? 1e-4 : 1e-6;
    const double value = constant->of(candidate.program);
    const double right = constant->of(start);
    if (std::abs(value - right) <= smallest_mistake * std::abs(right)) continue;
    candidate.add(constant->name, sentenceOn(*constant, value, right));
  }
  if (candidate.explanation.sentences.size() == mistakes) return false;
  keep(candidate, agreement.last_frame);
  return true;
}

void MistakeSearch::roundConstants(Candidate& candidate,
                                   const std::vector<const Constant*>& constants) {
  const StudentProgram fitted = candidate.program;
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    for (const Constant* constant : constants) {
      double& value = constant->of(candidate.program);
      value = parseNumber(roundedText(value, digits)).value_or(value);
    }
    const Agreement agreement = agreementOf(candidate);
    if (isConvincing(agreement)) return;
    candidate.program = fitted;
  }
}

}  // namespace spring_pendulum

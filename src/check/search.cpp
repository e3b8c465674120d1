#include "check/search.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace spring_pendulum {
namespace {

constexpr int kMostDigits = 15;  ///< significant digits of fitted constants
/// Smaller relative changes of a constant are rounding errors.
constexpr double kSmallestMistake = 1e-5;
constexpr std::string_view kSinglePrecision = "single_precision";

/// The differences between leading frames and motion, in units of the last digit printed.
/// \returns an empty vector if the limit was stopped
Eigen::ArrayXd differencesOf(const StudentProgram& program, const Particles& particles,
                             const AllFrames& frames, std::size_t window, WorkLimit& limit) {
  constexpr double kRounding = 1e-12;  // relative; weighs tiny numbers with many digits less
  constexpr double kDiverged = 1e12;
  const auto motion = motionOf(program, particles);
  const Eigen::Index size = 2 * particles.state.size();
  Eigen::ArrayXd result(static_cast<Eigen::Index>(window) * size);
  for (std::size_t n = 0; n < window; ++n) {
    const FrameNumbers& frame = frames.frames[n];
    if (!motion->advanceTo(frame.index, limit)) return {};
    const Eigen::ArrayX2d difference = (motion->positions() - frame.positions) /
                                       (frame.units + kRounding * frame.positions.abs().maxCoeff());
    Eigen::Map<Eigen::ArrayX2d>(result.data() + static_cast<Eigen::Index>(n) * size, size / 2, 2) =
        difference.isFinite().select(difference, kDiverged);
  }
  return result;
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
      if (mistake.name == kSinglePrecision) make(mistake);
  }
  bool canMake(const Mistake& mistake) const {
    return mistake.concerns(program) && mistake.name != kSinglePrecision &&
           (explanation.mistakes.empty() || explanation.mistakes.back() != mistake.name);
  }
  void add(std::string_view name, std::string sentence) {
    explanation.mistakes.emplace_back(name);
    explanation.sentences.push_back(std::move(sentence));
  }
};

std::vector<Explanation> MistakeSearch::singleMistakes(const std::vector<const Method*>& methods) {
  found_.clear();
  for (const Method* method : methods) tryMistakes(rightProgram(*method));
  found_.erase(std::remove_if(found_.begin(), found_.end(),
                              [&](const Explanation& one) { return !isStrong(one); }),
               found_.end());
  return found_;
}

std::vector<Explanation> MistakeSearch::search(const std::vector<const Method*>& methods) {
  using Level = void (MistakeSearch::*)(const Candidate&);
  constexpr Level kLevels[] = {&MistakeSearch::tryMistakes, &MistakeSearch::tryConstants,
                               &MistakeSearch::trySinglePrecision, &MistakeSearch::tryTwoMistakes,
                               &MistakeSearch::tryMistakeAndConstant};
  std::vector<Explanation> best;
  for (const Level level : kLevels) {
    found_.clear();
    for (const Method* method : methods) (this->*level)(rightProgram(*method));
    // A motion that explodes soon agrees with few frames; it must not hide a better explanation.
    std::stable_sort(found_.begin(), found_.end(), [](const Explanation& a, const Explanation& b) {
      return a.last_frame > b.last_frame;
    });
    if (found_.empty()) continue;
    if (isStrong(found_.front())) return found_;
    if (best.empty() && found_.front().mistakes.size() == 1) best = found_;
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
  if (frames_.are_floats) candidate.makeSinglePrecision();
  return candidate;
}

bool MistakeSearch::isOver() {
  gave_up_ |= limit_.isOver();
  return gave_up_;
}

void MistakeSearch::tryMistakesFrom(std::size_t first, const Candidate& base) {
  const std::vector<Mistake>& table = knownMistakes();
  if (first == 0 && frames_.are_floats && explains(base)) return;
  for (std::size_t i = first; i < table.size(); ++i) {
    if (!base.canMake(table[i]) || isOver()) continue;
    Candidate candidate = base;
    candidate.make(table[i]);
    explains(candidate);
  }
}

void MistakeSearch::tryConstants(const Candidate& base) {
  for (const Constant& constant : fittedConstants()) {
    for (const double factor : {1.0, 0.1, 10.0, -1.0}) {
      if (isOver() || fit(base, constant, factor)) break;
    }
  }
}

void MistakeSearch::trySinglePrecision(const Candidate& base) {
  constexpr int kDigitsOfFloat = 9;  // more digits show whether the numbers are floats
  if (frames_.are_floats || frames_.digits > kDigitsOfFloat) return;
  Candidate candidate = base;
  candidate.makeSinglePrecision();
  explains(candidate);
}

void MistakeSearch::tryTwoMistakes(const Candidate& base) {
  const std::vector<Mistake>& table = knownMistakes();
  for (std::size_t i = 0; i + 1 < table.size(); ++i) {
    if (!base.canMake(table[i])) continue;
    Candidate candidate = base;
    candidate.make(table[i]);
    tryMistakesFrom(i + 1, candidate);
  }
}

void MistakeSearch::tryMistakeAndConstant(const Candidate& base) {
  for (const Constant& constant : fittedConstants()) {
    for (const Mistake& mistake : knownMistakes()) {
      if (!base.canMake(mistake) || isOver()) continue;
      Candidate candidate = base;
      candidate.make(mistake);
      if (candidate.program.*constant.member == base.program.*constant.member)
        fit(candidate, constant);
    }
  }
}

Agreement MistakeSearch::agreementOf(const Candidate& candidate) {
  return compare(
      frames_, [&] { return motionOf(candidate.program, particles_); }, limit_);
}

bool MistakeSearch::explains(const Candidate& candidate, std::int64_t* last_frame) {
  const Agreement agreement = agreementOf(candidate);
  if (!agreement.complete || agreement.frames <= known_frames_ || isOver()) return false;
  if (last_frame != nullptr) {
    *last_frame = agreement.last_frame;
  } else {
    found_.push_back(candidate.explanation);
    found_.back().last_frame = agreement.last_frame;
  }
  return true;
}

bool MistakeSearch::improve(StudentProgram& program, const Constant& constant, std::size_t window) {
  constexpr int kMostSteps = 12;
  constexpr double kFirstChange = 1e-4;
  double& value = program.*constant.member;
  double before = value;
  Eigen::ArrayXd old = differencesOf(program, particles_, frames_, window, limit_);
  value += value == 0.0 ? kFirstChange : kFirstChange * value;
  for (int i = 0; i < kMostSteps && !isOver(); ++i) {
    const Eigen::ArrayXd now = differencesOf(program, particles_, frames_, window, limit_);
    if (now.size() != old.size() || now.size() == 0) return false;
    const Eigen::ArrayXd slope = (now - old) / (value - before);
    const double change = -(now * slope).sum() / slope.square().sum();
    if (!std::isfinite(change)) return i > 0;
    before = value;
    old = now;
    value += change;
    if (std::abs(change) <= 1e-15 * std::abs(value)) break;
  }
  return true;
}

bool MistakeSearch::fit(Candidate candidate, const Constant& constant, double factor) {
  double& value = candidate.program.*constant.member;
  const double right = value;
  value *= factor;
  Agreement agreement = agreementOf(candidate);
  while (!agreement.complete && !isOver()) {
    const std::size_t window =
        std::min(frames_.frames.size(), agreement.frames + agreement.frames / 2 + 2);
    if (!improve(candidate.program, constant, window)) return false;
    const std::size_t before = agreement.frames;
    agreement = agreementOf(candidate);
    if (!agreement.complete && agreement.frames <= before) return false;
  }
  if (!agreement.complete || agreement.frames <= known_frames_) return false;
  std::int64_t last_frame = agreement.last_frame;
  const double fitted = value;
  for (int digits = 1; digits <= kMostDigits; ++digits) {
    value = parseNumber(roundedText(fitted, digits)).value_or(fitted);
    if (explains(candidate, &last_frame)) break;
    value = fitted;
  }
  if (std::abs(value - right) <= kSmallestMistake * std::abs(right)) return false;
  candidate.add(constant.name, sentenceOn(constant, value, right));
  found_.push_back(candidate.explanation);
  found_.back().last_frame = last_frame;
  return true;
}

}  // namespace spring_pendulum

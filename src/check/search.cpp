#include "check/search.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Tries programs and keeps those that explain the frames.
class Trials {
 public:
  explicit Trials(Search& search) : search_(search) {}

  std::vector<Explanation> found;

  StudentProgram rightProgram(const Method& method) const {
    const StudentProgram right(method, search_.scenario);
    return search_.frames.are_floats ? right.with(knownMistakes().back()) : right;
  }

  void tryMistakes(const StudentProgram& base) {
    if (!search_.frames.are_floats || !explains(base)) tryMistakesFrom(0, base);
  }

  void tryConstants(const StudentProgram& base) {
    for (const Constant& constant : fittedConstants()) {
      for (const double factor : {1.0, 0.1, 10.0, -1.0}) {
        if (isOver() || fit(base, constant, factor)) break;
      }
    }
  }

  void trySinglePrecision(const StudentProgram& base) {
    constexpr int kDigitsOfFloat = 9;  // more digits show whether the numbers are floats
    if (!search_.frames.are_floats && search_.frames.digits <= kDigitsOfFloat)
      explains(base.with(knownMistakes().back()));
  }

  void tryTwoMistakes(const StudentProgram& base) {
    const std::vector<Mistake>& table = knownMistakes();
    for (std::size_t i = 0; i + 1 < table.size(); ++i) {
      if (base.canMake(table[i])) tryMistakesFrom(i + 1, base.with(table[i]));
    }
  }

  void tryMistakeAndConstant(const StudentProgram& base) {
    StudentProgram right = base;
    for (const Constant& constant : fittedConstants()) {
      for (const Mistake& mistake : knownMistakes()) {
        if (!base.canMake(mistake) || isOver()) continue;
        StudentProgram wrong = base.with(mistake);
        if (constant.in(wrong) == constant.in(right)) fit(wrong, constant);
      }
    }
  }

 private:
  bool isOver() { return search_.gave_up |= search_.limit.isOver(); }

  void tryMistakesFrom(std::size_t first, const StudentProgram& base) {
    const std::vector<Mistake>& table = knownMistakes();
    for (std::size_t i = first; i < table.size() && !isOver(); ++i) {
      if (base.canMake(table[i])) explains(base.with(table[i]));
    }
  }

  Agreement agreementOf(const StudentProgram& program) {
    return compare(
        search_.frames, [&] { return motionOf(program, search_.particles); }, search_.limit);
  }
  bool isExplanation(const Agreement& agreement) {
    return agreement.complete && agreement.frames > search_.known_frames && !isOver();
  }
  bool explains(const StudentProgram& program) {
    const Agreement agreement = agreementOf(program);
    if (!isExplanation(agreement)) return false;
    found.push_back({program, agreement.last_frame});
    return true;
  }

  /// Fits a constant to a frame: the secant method for least squares.
  void improve(StudentProgram& program, const Constant& constant, const FrameNumbers& frame) {
    constexpr int kMostSteps = 12;
    constexpr double kFirstChange = 1e-4;
    constexpr double kRounding = 1e-12;  // relative; weighs tiny numbers with many digits less
    const auto differences = [&]() -> Eigen::ArrayX2d {
      const auto motion = motionOf(program, search_.particles);
      motion->advanceTo(frame.index, search_.limit);
      return (motion->positions() - frame.positions) /
             (frame.units + kRounding * frame.positions.abs().maxCoeff());
    };
    double& value = constant.in(program);
    double change = value == 0.0 ? kFirstChange : kFirstChange * value;
    Eigen::ArrayX2d old = differences();
    for (int i = 0; i < kMostSteps && !isOver(); ++i) {
      value += change;
      const Eigen::ArrayX2d now = differences();
      const Eigen::ArrayX2d slope = (now - old) / change;
      change = -(now * slope).sum() / slope.square().sum();
      if (!std::isfinite(change) || std::abs(change) <= 1e-15 * std::abs(value)) return;
      old = now;
    }
  }

  /// Fits a constant, starting from its value times `factor`, to more and more frames, and rounds it.
  bool fit(StudentProgram program, const Constant& constant, double factor = 1.0) {
    constexpr double kSmallestMistake = 1e-5;  // relative; smaller ones are rounding errors
    constexpr int kMostDigits = 15;
    const std::vector<FrameNumbers>& frames = search_.frames.frames;
    double& value = constant.in(program);
    const double right = value;
    value *= factor;
    Agreement agreement = agreementOf(program);
    while (!agreement.complete && !isOver()) {
      const std::size_t before = agreement.frames;
      improve(program, constant, frames[std::min(frames.size() - 1, before + before / 2)]);
      agreement = agreementOf(program);
      if (!agreement.complete && agreement.frames <= before) return false;
    }
    if (!isExplanation(agreement)) return false;
    const double fitted = value;
    for (int digits = 1; digits <= kMostDigits; ++digits) {
      value = parseNumber(roundedText(fitted, digits)).value_or(fitted);
      if (isExplanation(agreementOf(program))) break;
    }
    const double scale = right == 0.0 ? 1.0 : std::abs(right);
    if (std::abs(value - right) <= kSmallestMistake * scale) return false;
    std::string sentence(constant.sentence);
    sentence.replace(sentence.find("{}"), 2, roundedText(value, kMostDigits));
    program.mistakes.emplace_back(constant.name);
    program.sentences.push_back(fmt::format("{} instead of {}", sentence, roundedText(right, 6)));
    return explains(program);
  }

  Search& search_;
};

}  // namespace

std::vector<Explanation> findMistakes(Search& search, const Methods& methods, bool only_single) {
  constexpr void (Trials::*kLevels[])(const StudentProgram&) = {
      &Trials::tryMistakes, &Trials::tryConstants, &Trials::trySinglePrecision,
      &Trials::tryTwoMistakes, &Trials::tryMistakeAndConstant};
  constexpr std::size_t kEvidence = 20;  // frames after the departure that a strong explanation has
  const std::vector<FrameNumbers>& frames = search.frames.frames;
  const std::int64_t far =
      frames[std::min(search.known_frames + kEvidence, frames.size() - 1)].index;
  Trials trials(search);
  std::vector<Explanation> best;
  for (const auto level : kLevels) {
    for (const Method* method : methods) (trials.*level)(trials.rightProgram(*method));
    std::vector<Explanation> found = std::exchange(trials.found, {});
    // A motion that explodes soon agrees with few frames; it must not hide a better explanation.
    const auto weak = std::stable_partition(
        found.begin(), found.end(), [&](const Explanation& one) { return one.last_frame >= far; });
    if (weak != found.begin()) return {found.begin(), weak};
    if (only_single) break;
    if (best.empty() && !found.empty() && found.front().program.mistakes.size() == 1) best = found;
  }
  return best;
}

}  // namespace spring_pendulum

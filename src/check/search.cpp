#include "check/search.hpp"

#include "base/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "check/mistakes.hpp"

namespace spring_pendulum {
namespace {

constexpr int kMostDigits = 15;  ///< significant digits of fitted constants
/// Smaller relative changes of a constant are rounding errors.
constexpr double kSmallestMistake = 1e-5;
constexpr std::string_view kSinglePrecision = "single_precision";

struct Candidate {
  StudentProgram program;
  Explanation explanation;

  Candidate with(const Mistake& mistake) const {
    Candidate other = *this;
    mistake.make(other.program);
    other.add(mistake.name, std::string(mistake.sentence));
    return other;
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

/// Tries candidates and keeps those that explain the frames.
class Trials {
 public:
  explicit Trials(Search& search) : search_(search) {}

  std::vector<Explanation> take() { return std::exchange(found_, {}); }

  Candidate rightProgram(const Method& method) const {
    Candidate right{StudentProgram(*method.tableau, search_.scenario), {method.name, {}, {}, 0}};
    return search_.frames.are_floats ? inSinglePrecision(right) : right;
  }

  void tryMistakes(const Candidate& base) {
    if (!search_.frames.are_floats || !explains(base)) tryMistakesFrom(0, base);
  }

  void tryConstants(const Candidate& base) {
    for (const Constant& constant : fittedConstants()) {
      for (const double factor : {1.0, 0.1, 10.0, -1.0}) {
        if (isOver() || fit(base, constant, factor)) break;
      }
    }
  }

  void trySinglePrecision(const Candidate& base) {
    constexpr int kDigitsOfFloat = 9;  // more digits show whether the numbers are floats
    if (!search_.frames.are_floats && search_.frames.digits <= kDigitsOfFloat)
      explains(inSinglePrecision(base));
  }

  void tryTwoMistakes(const Candidate& base) {
    const std::vector<Mistake>& table = knownMistakes();
    for (std::size_t i = 0; i + 1 < table.size(); ++i) {
      if (base.canMake(table[i])) tryMistakesFrom(i + 1, base.with(table[i]));
    }
  }

  void tryMistakeAndConstant(const Candidate& base) {
    for (const Constant& constant : fittedConstants()) {
      for (const Mistake& mistake : knownMistakes()) {
        if (!base.canMake(mistake) || isOver()) continue;
        const Candidate candidate = base.with(mistake);
        if (candidate.program.*constant.member == base.program.*constant.member)
          fit(candidate, constant);
      }
    }
  }

 private:
  static Candidate inSinglePrecision(const Candidate& base) {
    const std::vector<Mistake>& table = knownMistakes();
    return base.with(*std::find_if(table.begin(), table.end(), [](const Mistake& mistake) {
      return mistake.name == kSinglePrecision;
    }));
  }

  bool isOver() {
    search_.gave_up |= search_.limit.isOver();
    return search_.gave_up;
  }

  void tryMistakesFrom(std::size_t first, const Candidate& base) {
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
  void keep(const Candidate& candidate, const Agreement& agreement) {
    found_.push_back(candidate.explanation);
    found_.back().last_frame = agreement.last_frame;
  }
  bool explains(const Candidate& candidate) {
    const Agreement agreement = agreementOf(candidate.program);
    if (!isExplanation(agreement)) return false;
    keep(candidate, agreement);
    return true;
  }

  /// The differences between leading frames and motion, in units of the last digit printed.
  Eigen::ArrayXd differencesOf(const StudentProgram& program, std::size_t window) {
    constexpr double kRounding = 1e-12;  // relative; weighs tiny numbers with many digits less
    constexpr double kDiverged = 1e12;
    const auto motion = motionOf(program, search_.particles);
    const Eigen::Index size = search_.particles.state.size();
    Eigen::ArrayXd result = Eigen::ArrayXd::Zero(static_cast<Eigen::Index>(window) * 2 * size);
    for (std::size_t n = 0; n < window; ++n) {
      const FrameNumbers& frame = search_.frames.frames[n];
      if (!motion->advanceTo(frame.index, search_.limit)) break;
      const Eigen::ArrayX2d difference =
          (motion->positions() - frame.positions) /
          (frame.units + kRounding * frame.positions.abs().maxCoeff());
      Eigen::Map<Eigen::ArrayX2d>(result.data() + static_cast<Eigen::Index>(n) * 2 * size, size,
                                  2) = difference.isFinite().select(difference, kDiverged);
    }
    return result;
  }

  /// Fits a constant to the leading frames of a window: the secant method for least squares.
  void improve(StudentProgram& program, const Constant& constant, std::size_t window) {
    constexpr int kMostSteps = 12;
    constexpr double kFirstChange = 1e-4;
    double& value = program.*constant.member;
    double before = value;
    Eigen::ArrayXd old = differencesOf(program, window);
    value += value == 0.0 ? kFirstChange : kFirstChange * value;
    for (int i = 0; i < kMostSteps && !isOver(); ++i) {
      const Eigen::ArrayXd now = differencesOf(program, window);
      const Eigen::ArrayXd slope = (now - old) / (value - before);
      const double change = -(now * slope).sum() / slope.square().sum();
      if (!std::isfinite(change)) return;
      before = value;
      old = now;
      value += change;
      if (std::abs(change) <= 1e-15 * std::abs(value)) return;
    }
  }

  /// Fits a constant, starting from its value times `factor`, to more and more frames, and rounds it.
  bool fit(Candidate candidate, const Constant& constant, double factor = 1.0) {
    double& value = candidate.program.*constant.member;
    const double right = value;
    value *= factor;
    Agreement agreement = agreementOf(candidate.program);
    while (!agreement.complete && !isOver()) {
      const std::size_t before = agreement.frames;
      improve(candidate.program, constant,
              std::min(search_.frames.frames.size(), before + before / 2 + 2));
      agreement = agreementOf(candidate.program);
      if (!agreement.complete && agreement.frames <= before) return false;
    }
    if (!isExplanation(agreement)) return false;
    const double fitted = value;
    for (int digits = 1; digits <= kMostDigits; ++digits) {
      value = parseNumber(roundedText(fitted, digits)).value_or(fitted);
      agreement = agreementOf(candidate.program);
      if (isExplanation(agreement)) break;
    }
    if (std::abs(value - right) <= kSmallestMistake * std::abs(right)) return false;
    std::string sentence(constant.sentence);
    sentence.replace(sentence.find("{}"), 2, roundedText(value, kMostDigits));
    candidate.add(constant.name, fmt::format("{} instead of {}", sentence, roundedText(right, 6)));
    keep(candidate, agreement);
    return true;
  }

  Search& search_;
  std::vector<Explanation> found_;
};

/// Whether an explanation reproduces all frames, or many that show the mistake.
bool isStrong(const Search& search, const Explanation& explanation) {
  constexpr std::size_t kEvidence = 20;  // frames after the departure
  const std::vector<FrameNumbers>& frames = search.frames.frames;
  return explanation.last_frame >=
         frames[std::min(search.known_frames + kEvidence, frames.size() - 1)].index;
}

}  // namespace

std::vector<Explanation> singleMistakes(Search& search, const std::vector<const Method*>& methods) {
  Trials trials(search);
  for (const Method* method : methods) trials.tryMistakes(trials.rightProgram(*method));
  std::vector<Explanation> found = trials.take();
  found.erase(std::remove_if(found.begin(), found.end(),
                             [&](const Explanation& one) { return !isStrong(search, one); }),
              found.end());
  return found;
}

std::vector<Explanation> simplestMistakes(Search& search,
                                          const std::vector<const Method*>& methods) {
  constexpr void (Trials::*kLevels[])(const Candidate&) = {
      &Trials::tryMistakes, &Trials::tryConstants, &Trials::trySinglePrecision,
      &Trials::tryTwoMistakes, &Trials::tryMistakeAndConstant};
  Trials trials(search);
  std::vector<Explanation> best;
  for (const auto level : kLevels) {
    for (const Method* method : methods) (trials.*level)(trials.rightProgram(*method));
    std::vector<Explanation> found = trials.take();
    // A motion that explodes soon agrees with few frames; it must not hide a better explanation.
    std::stable_sort(found.begin(), found.end(), [](const Explanation& a, const Explanation& b) {
      return a.last_frame > b.last_frame;
    });
    if (found.empty()) continue;
    if (isStrong(search, found.front())) return found;
    if (best.empty() && found.front().mistakes.size() == 1) best = found;
  }
  return best;
}

}  // namespace spring_pendulum

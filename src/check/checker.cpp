#include "check/checker.hpp"

#include "base/numbers.hpp"
#include "check/motion.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Methods of the exercise, and of other courses: those are right only if they are asked for.
constexpr unsigned kOfExercise =
    StudentProgram::kEuler | StudentProgram::kMidpoint | StudentProgram::kRungeKutta4;
constexpr unsigned kOfCourses = StudentProgram::kHeun | StudentProgram::kOtherTableau;

using Methods = std::vector<const Method*>;
using Programs = std::vector<StudentProgram>;

class Checker {
 public:
  Checker(const Scenario& scenario, const Scene& particles, AllFrames frames, bool method_is_given,
          std::function<bool()> stop)
      : scenario_(scenario),
        particles_(particles),
        frames_(std::move(frames)),
        search_limit_{kMostWork, std::move(stop)} {
    for (const Method& method : methodTable()) {
      const bool is_wanted =
          method_is_given ? &method == &scenario.method.get() : (kindOf(method) & kOfCourses) == 0;
      (is_wanted ? wanted_ : others_).push_back(&method);
    }
  }

  FrameCheck check() {
    compareWith(wanted_);
    if (methods_.empty() && frames_.renumber(particles_.state.positions())) {
      departure_.reset();
      compareWith(wanted_);
    }
    if (search_limit_.isStopped()) throw FileError("stopped before the frames were compared");
    FrameCheck result = methods_.empty() && departure_ ? different() : equal();
    for (const std::string& note : frames_.notes) result.lines.push_back("note: " + note);
    return result;
  }

 private:
  static constexpr double kMostWork = 10.0;  ///< s

  /// Notes the methods that agree longest, and the nearest departure.
  void compareWith(const Methods& methods) {
    const Chain chain(particles_.masses, scenario_.constants);
    double left = 2.0 * kMostWork;  // a method that agrees long may take half
    bool is_undecided = false;      // whether it is too late to compare some method
    for (const Method* method : methods) {
      Plan plan = scenario_;
      plan.method = *method;
      WorkLimit work{left / 2.0, search_limit_.stop};
      const auto make = [&] { return motionOf(plan, chain, particles_); };
      Agreement agreement = compare(frames_, make, work);
      if (agreement.departure && kindOf(*method) != 0) {
        Agreement plain = agreementWith(StudentProgram(*method, scenario_), work);
        // It may get further, or to a frame that cannot be compared.
        if (plain.frames >= agreement.frames + (plain.departure ? 1 : 0)) agreement = plain;
      }
      is_undecided = is_undecided || (!agreement.departure && agreement.frames == 0);
      left -= work.done;
      if (work.isStopped()) return;
      if (agreement.complete && agreement.last_frame >= last_frame_) {
        if (agreement.last_frame > last_frame_) methods_.clear();
        last_frame_ = agreement.last_frame;
        const std::string within = fmt::format(" within {} m", numberText(plan.tolerance));
        methods_.push_back(method->name + (method->hasFixedStep() ? "" : within));
      }
      // The departure from the nearest of the wanted methods that students write, or from the only one.
      const bool is_nearer = !departure_ || agreement.frames > known_frames_ ||
                             (agreement.frames == known_frames_ && agreement.departure &&
                              agreement.departure->distance < departure_->distance);
      if (!agreement.departure || !is_nearer || &methods != &wanted_) continue;
      if (kindOf(*method) == 0 && methods.size() > 1) continue;
      known_frames_ = agreement.frames;
      departure_ = agreement.departure;
      nearest_ = plan;
    }
    if (is_undecided && &methods == &wanted_) departure_.reset();
  }

  /// Looks for mistakes in the wanted method, then for another method, then for mistakes in others.
  Programs explain() {
    Methods written;
    for (const Method* method : wanted_)  // the best first
      if (kindOf(*method) != 0) written.insert(written.begin(), method);
    if (written.empty()) frames_.notes.emplace_back("no mistakes in the wanted method are known");
    Programs found = findMistakes(written, 1);
    if (!found.empty()) return found;
    compareWith(others_);
    if (last_frame_ > frames_.start) return found;
    methods_.clear();
    for (const Method* method : others_)
      if ((kindOf(*method) & kOfExercise) != 0) written.push_back(method);
    found = findMistakes(written, 5);
    if (found.empty() && !right_.empty())
      frames_.notes.push_back("frames of " + right_ +
                              " with a constant too near the right one to be named");
    if (found.empty() && right_.empty() && search_limit_.isOver())
      frames_.notes.emplace_back("the search for mistakes stopped before all were tried");
    return found;
  }

  /// Returns the simplest explanations on the first levels.
  Programs findMistakes(const Methods& methods, int levels) {
    constexpr std::size_t kEvidence = 20;  // frames after the departure in a strong explanation
    const std::vector<FrameNumbers>& frames = frames_.frames;
    const std::int64_t far = frames[std::min(known_frames_ + kEvidence, frames.size() - 1)].index;
    Programs best;
    for (int level = 0; level < (right_.empty() ? levels : 3); ++level) {
      for (const Method* method : methods) tryMistakes(StudentProgram(*method, scenario_), level);
      Programs found = std::exchange(found_, {});
      std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
        return std::tuple(a.mistakes.size(), b.last_frame, a.single_precision) <
               std::tuple(b.mistakes.size(), a.last_frame, b.single_precision);
      });
      // A motion that explodes soon agrees with few frames; it must not hide a better explanation.
      const auto weak = std::stable_partition(
          found.begin(), found.end(), [&](const auto& one) { return one.last_frame >= far; });
      if (weak != found.begin()) return {found.begin(), weak};
      if (best.empty() && levels > 1 && level < 3) best = found;
    }
    return best;
  }

  /// Tries, by level, a mistake, a wrong number, float, two mistakes, or a mistake and a wrong number.
  void tryMistakes(StudentProgram right, int level) {
    StudentProgram in_float = right.with(table_.back());
    if (level < 2) tryChanges(right, 0, level == 1);  // perhaps it prints floats only
    if (level == 0 && frames_.are_floats && explains(in_float)) return tryChanges(right, 0, true);
    in_float.sentences.back() += " (or has errors of up to some 50 times those of float)";
    if (frames_.are_floats) right = in_float;
    for (int i = 0; i < 2 && level == 2 && frames_.are_floats; ++i) tryChanges(right, 0, i == 1);
    const bool may_be_float = !frames_.are_floats && frames_.digits < 9;  // which show it
    if (level == 2 && may_be_float) explains(in_float);
    for (std::size_t i = 0; level > 2 && i + 1 < table_.size(); ++i)
      if (right.canMake(table_[i])) tryChanges(right.with(table_[i]), i + 1, level == 4);
  }

  /// Tries all mistakes from `first` on, or wrong numbers, besides those that a program has.
  void tryChanges(const StudentProgram& base, std::size_t first, bool numbers) {
    for (const Constant& constant : fittedConstants())
      for (const double factor : {1.0, 0.1, 10.0, -1.0})
        if (!numbers || search_limit_.isOver() || fit(base, constant, factor) ||
            !base.mistakes.empty())
          break;
    for (std::size_t i = first; i < table_.size() && !numbers && !search_limit_.isOver(); ++i)
      if (base.canMake(table_[i])) explains(base.with(table_[i]));
  }

  Agreement agreementWith(const StudentProgram& program, WorkLimit& limit) const {
    const auto make = [&] { return motionOf(program, particles_); };
    return compare(frames_, make, limit);
  }

  /// Rounding errors that are visible, and as large as the departure, would explain any departure.
  bool isExplanation(const StudentProgram& program, const Agreement& agreement) const {
    const double visible = (program.single_precision ? 1e-4 : 1e-6) *
                           frames_.frames[known_frames_].positions.abs().maxCoeff();
    return agreement.complete && agreement.frames > known_frames_ && !search_limit_.isOver() &&
           !(agreement.roundings[known_frames_] > std::max(0.1 * departure_->distance, visible));
  }

  bool explains(StudentProgram program) {
    const Agreement agreement = agreementWith(program, search_limit_);
    program.last_frame = agreement.last_frame;
    if (isExplanation(program, agreement)) found_.push_back(program);
    return isExplanation(program, agreement);
  }

  /// Fits a constant to the frames up to `last`: the secant method for least squares.
  void improve(StudentProgram& program, const Constant& constant, std::size_t last) {
    constexpr double kRounding = 1e-12;  // relative; weighs tiny numbers with many digits less
    constexpr std::size_t kMostNumbers = 4'000'000;  // bounds the memory
    const Eigen::Index size = particles_.state.size();
    const std::size_t first = last - std::min(last, kMostNumbers / static_cast<std::size_t>(size));
    const auto differences = [&] {
      Eigen::ArrayX2d all(size * static_cast<Eigen::Index>(last - first + 1), 2);
      const auto motion = motionOf(program, particles_);
      for (Eigen::Index row = 0; row < all.rows(); row += size) {
        const FrameNumbers& frame = frames_.frames[first + static_cast<std::size_t>(row / size)];
        motion->advanceTo(frame.index, search_limit_);
        all.middleRows(row, size) = (motion->positions() - frame.positions) /
                                    (frame.units + kRounding * frame.positions.abs().maxCoeff());
      }
      return Eigen::ArrayX2d((all.abs() < 1e150).select(all, 0.0));  // without nan
    };
    double& value = constant.in(program);
    double change = 1e-4 * (value == 0.0 ? 1.0 : value);
    Eigen::ArrayX2d old = differences();
    for (int i = 0; i < 12 && !search_limit_.isOver(); ++i) {
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
    constexpr double kLeast = 1e-5;  // mistake, relative; smaller ones are rounding errors
    constexpr int kMostDigits = 15;
    StudentProgram asked(program.method, scenario_);
    double& value = constant.in(program);
    const double right = value;
    if (right != constant.in(asked)) return false;  // would take back a mistake
    value *= factor;
    Agreement agreement = agreementWith(program, search_limit_);
    const auto round = [&](int most_digits) {
      const double fitted = value;
      for (int digits = 0; digits <= most_digits; ++digits) {
        value = digits == 0 ? 0.0 : parseNumber(roundedText(fitted, digits)).value_or(fitted);
        Agreement rounded = agreementWith(program, search_limit_);
        if (rounded.complete) return rounded;
      }
      value = fitted;
      return agreement;
    };
    while (!agreement.complete && !search_limit_.isOver()) {
      const std::size_t before = agreement.frames;
      const std::size_t next = std::min(frames_.frames.size() - 1, before + before / 2);
      improve(program, constant, next);
      agreement = agreementWith(program, search_limit_);
      if (!agreement.complete) agreement = round(6);  // a student writes few digits
      if (!agreement.complete && agreement.frames <= before) return false;
    }
    if (!isExplanation(program, agreement)) return false;
    program.last_frame = round(kMostDigits).last_frame;
    const bool is_tiny = std::abs(value - right) <= kLeast * std::abs(right == 0.0 ? 1.0 : right);
    if (is_tiny && program.mistakes.empty()) right_ = program.method.get().name;
    if (is_tiny || program.time_step < 0.0) return false;  // backwards, undamped motion is the same
    std::string sentence(constant.sentence);
    sentence.replace(sentence.find("{}"), 2, roundedText(value, kMostDigits));
    program.mistakes.emplace_back(constant.name);
    program.sentences.push_back(fmt::format("{} instead of {}", sentence, roundedText(right, 6)));
    found_.push_back(program);
    return true;
  }

  /// "Euler or Auto: all 500 frames in the 6 digits printed"
  std::string methodsText() const {
    const auto count = static_cast<std::int64_t>(frames_.frames.size());
    const std::string which = last_frame_ == frames_.frames.back().index
                                  ? "all " + counted(count, "frame")
                                  : fmt::format("frames up to {}", last_frame_);
    return fmt::format("{}: {} in the {} printed", fmt::join(methods_, " or "), which,
                       counted(std::min(frames_.digits, 17), "digit"));
  }

  FrameCheck equal() const {
    constexpr const char* kTooLate = "small errors grow too much, or it takes too long";
    const std::int64_t last = scenario_.frames - 1;
    // Programs differ by a frame or so in how they count.
    const bool has_last = last_frame_ >= std::max(std::min(last, frames_.start + 1),
                                                  std::min(last - 2, last * 49 / 50));
    std::string text = has_last ? "" : "undecided: ";
    if (methods_.empty()) {
      text += fmt::format("frame {} is the first one, and too late to be compared: {}",
                          frames_.frames.front().index, kTooLate);
    } else {
      text += "equal to " + methodsText();
      if (last_frame_ != frames_.frames.back().index)
        text += fmt::format("; later frames are not compared: {}", kTooLate);
      else if (!has_last)
        text += fmt::format("; frames up to {} are missing (--frames {})", last, scenario_.frames);
    }
    return {has_last ? FrameVerdict::kEqual : FrameVerdict::kUndecided, {text}};
  }

  FrameCheck different() {
    const Programs found = explain();
    const double time = nearest_.timeOfFrame(departure_->frame);
    std::vector<std::string> lines{
        "", fmt::format("depart from {} at frame {}, t = {} s, {}", nearest_.method.get().name,
                        departure_->frame, roundedText(time, 6), departure_->text)};
    for (std::size_t i = 0; i < std::min<std::size_t>(found.size(), 3); ++i) {
      const StudentProgram& program = found[i];
      lines.push_back(fmt::format("{}{}: the program {} (reproduces the frames{})",
                                  i == 0 ? "" : "or ", program.method.get().name,
                                  fmt::join(program.sentences, " and "),
                                  program.last_frame == frames_.frames.back().index
                                      ? ""
                                      : fmt::format(" up to {}", program.last_frame)));
    }
    lines.front() = !methods_.empty() ? "different: frames of " + methodsText()
                    : found.empty()
                        ? "different: no known mistake reproduces the frames"
                        : fmt::format("different: {} with {}", found.front().method.get().name,
                                      fmt::join(found.front().mistakes, " + "));
    return {FrameVerdict::kDifferent, lines, time};
  }

  const Scenario& scenario_;
  const Scene& particles_;
  AllFrames frames_;
  WorkLimit search_limit_;
  Methods wanted_, others_;
  std::vector<std::string> methods_;  ///< those that the frames equal longest
  std::int64_t last_frame_ = -1;      ///< the last one that could be compared
  std::size_t known_frames_ = 0;      ///< number of frames before the departure
  std::optional<Departure> departure_;
  std::string right_;  ///< a method that is right but for a number too near to be named
  Programs found_;
  const std::vector<Mistake>& table_ = knownMistakes();
  Plan nearest_;  ///< with the method from which the frames depart
};

}  // namespace

FrameCheck checkFrames(const Scenario& scenario, const Scene& particles,
                       std::vector<FrameText> frames, bool method_is_given,
                       const std::function<bool()>& stop) {
  checkScenario(scenario);
  AllFrames numbers = readFrames(std::move(frames), particles);
  return Checker(scenario, particles, std::move(numbers), method_is_given, stop).check();
}

}  // namespace spring_pendulum

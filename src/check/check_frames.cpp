#include "check/check_frames.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/comparison.hpp"
#include "check/frame_numbers.hpp"
#include "check/mistake_search.hpp"

namespace spring_pendulum {
namespace {

/// Work that a comparison with one method, or a search for mistakes, may take, in spring forces of the
/// library: some 10 s.
constexpr double kMostWork = 4e9;

/// Work of a search for mistakes that right frames do not show.
constexpr double kMostDoubtWork = 4e8;

using Methods = std::vector<const Method*>;

bool isExercise(const Method& method) {
  return method.hasFixedStep() && method.tableau != nullptr;
}

class Checker {
 public:
  Checker(const Scenario& scenario, const Particles& particles, const AllFrames& frames,
          const CheckOptions& options)
      : scenario_(scenario), particles_(particles), frames_(frames), options_(options) {
    for (const Method& method : methodTable()) {
      const bool is_wanted = options.method_is_given && &method == &scenario.method.get();
      (is_wanted || !options.method_is_given ? wanted_ : others_).push_back(&method);
    }
    result_.remarks = frames.remarks;
    result_.frames = static_cast<std::int64_t>(frames.frames.size());
    result_.printed_digits = frames.digits;
  }

  FrameCheck check() {
    compareWith(wanted_);
    if (isStopped()) throw FileError("stopped before the frames were compared");
    if (result_.methods.empty() && !unknown_.empty()) {
      throw FileError(
          fmt::format("frame {}: is the first one, and too late to be compared with {}: "
                      "rounding errors grow too much, or it takes too long",
                      frames_.frames.front().index, unknown_));
    }
    result_.equal = !result_.methods.empty();
    if (result_.equal) {
      result_.departure.reset();
      doubt();
      describeEqual();
    } else {
      explain();
      describeDifferent();
    }
    return result_;
  }

 private:
  /// Missing frames make each comparison slower, and tell nothing.
  double mostWork() const {
    constexpr double kMostMissing = 30.0;  // for each frame that is there
    const auto there = static_cast<double>(result_.frames);
    const auto needed = static_cast<double>(frames_.lastIndex() + 1);
    return kMostWork * std::min(1.0, kMostMissing * there / needed);
  }

  bool isStopped() const { return options_.stop && options_.stop(); }

  void compareWith(const Methods& methods) {
    for (const Method* method : methods) {
      if (isStopped()) return;
      WorkLimit limit{mostWork(), options_.stop};
      const Agreement agreement = compare(
          frames_, [&] { return motionOf(*method, scenario_, particles_); }, limit);
      if (agreement.complete && (result_.methods.empty() || agreement.frames > agreeing_)) {
        note(agreement);
      }
      if (agreement.complete) result_.methods.push_back(method->name);
      if (agreement.frames == 0 && !agreement.departure && !isStopped()) unknown_ = method->name;
      noteNearest(*method, agreement);
    }
  }

  void note(const Agreement& agreement) {
    agreeing_ = agreement.frames;
    result_.last_frame = agreement.last_frame;
    result_.digits = frames_.digits;
    if (agreement.distance == 0.0 || agreement.scale == 0.0) return;
    const double largest_digit = std::floor(std::log10(agreement.scale));
    const double digits = largest_digit - std::log10(1.99 * agreement.distance) + 1.0;
    result_.digits = std::clamp(static_cast<int>(digits), 0, frames_.digits);
  }

  void noteNearest(const Method& method, const Agreement& agreement) {
    if (agreement.complete || (result_.departure && agreement.frames <= departing_)) return;
    departing_ = agreement.frames;
    result_.nearest = method.name;
    result_.departure = agreement.departure;
    if (!result_.departure) return;
    Scenario with_method = scenario_;
    with_method.method = method;
    result_.departure->time = frameSteps(with_method).timeOfFrame(result_.departure->frame);
  }

  /// Looks for mistakes in the wanted method, then for another method, then for mistakes in others.
  void explain() {
    Methods exercise;
    Methods first;
    for (const Method& method : methodTable()) {
      if (!isExercise(method)) continue;
      const bool is_wanted = std::find(wanted_.begin(), wanted_.end(), &method) != wanted_.end();
      (is_wanted ? first : exercise).push_back(&method);
    }
    MistakeSearch search(scenario_, particles_, frames_, departing_, {mostWork(), options_.stop});
    for (const Method* method : options_.method_is_given ? first : Methods{}) {
      result_.explanations = search.singleMistakes(*method);
    }
    if (result_.explanations.empty()) compareWith(others_);
    if (result_.explanations.empty() && result_.methods.empty()) {
      result_.explanations = search.search({first, exercise});
    }
    if (result_.explanations.empty() && search.gaveUp())
      result_.remarks.emplace_back("the search for mistakes stopped before all were tried");
  }

  /// Right frames: names mistakes that they would not show, and mistakes by which a method of the
  /// exercise becomes another one of the table.
  void doubt() {
    MistakeSearch search(scenario_, particles_, frames_, 0, {kMostDoubtWork, options_.stop});
    const Method& best = findMethod(result_.methods.front());
    if (isExercise(best)) {
      std::vector<std::string> hidden;
      for (const Explanation& one : search.singleMistakes(best)) {
        const std::string& name = one.mistakes.back();
        if (std::find(hidden.begin(), hidden.end(), name) == hidden.end()) hidden.push_back(name);
      }
      constexpr std::size_t kMostNamed = 12;
      if (hidden.empty()) return;
      result_.remarks.push_back(
          hidden.size() > kMostNamed
              ? "these frames would show hardly any mistake; give more frames "
                "or digits, or another scene"
              : fmt::format("this scene and these digits would not show the "
                            "mistakes {}",
                            fmt::join(hidden, ", ")));
    } else if (best.hasFixedStep()) {
      for (const Method& method : methodTable()) {
        if (!isExercise(method)) continue;
        for (const Explanation& one : search.singleMistakes(method)) {
          result_.explanations.push_back(one);
          result_.remarks.push_back(fmt::format("{} gives the same if the program {}", method.name,
                                                one.sentences.front()));
        }
      }
    }
  }

  void describeEqual();
  void describeDifferent();
  std::string comparedText() const;

  const Scenario& scenario_;
  const Particles& particles_;
  const AllFrames& frames_;
  const CheckOptions& options_;
  Methods wanted_;
  Methods others_;
  std::string unknown_;        ///< a method that even the first frame can't be compared with
  std::size_t agreeing_ = 0;   ///< number of frames
  std::size_t departing_ = 0;  ///< number of frames before the departure
  FrameCheck result_;
};

std::string listOf(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? fmt::format(" {} ", last) : ", ";
    text += words[i];
  }
  return text;
}

std::string Checker::comparedText() const {
  const bool all = result_.last_frame == frames_.lastIndex();
  return fmt::format(
      "{} to {} of {} printed{}",
      all ? "all " + counted(result_.frames, "frame")
          : fmt::format("frames up to {}", result_.last_frame),
      result_.digits, counted(result_.printed_digits, "digit"),
      all ? ""
          : "; later frames are not compared: rounding errors grow too much, or it takes too long");
}

void Checker::describeEqual() {
  result_.text = fmt::format("equal to {}: {}", result_.methods.front(), comparedText());
  if (result_.methods.size() > 1) {
    const std::vector<std::string> others(result_.methods.begin() + 1, result_.methods.end());
    result_.remarks.push_back(
        fmt::format("{} would look the same in these digits", listOf(others, "and")));
  }
}

void Checker::describeDifferent() {
  const Departure& departure = result_.departure.value_or(Departure{});
  result_.text = fmt::format(
      "different: depart from {} at frame {}, t = {} s, particle {}, {}", result_.nearest,
      departure.frame, roundedText(departure.time, 6), departure.particle,
      std::isfinite(departure.distance) ? fmt::format("by {} m", roundedText(departure.distance, 2))
                                        : "where the frame has a number that is not finite");
  if (!result_.methods.empty()) {
    result_.text +=
        fmt::format("\nThey are frames of {}: {}.", listOf(result_.methods, "or"), comparedText());
    return;
  }
  if (result_.explanations.empty()) {
    result_.text += "\nNo known mistake reproduces them.";
    return;
  }
  constexpr std::size_t kMostShown = 3;
  std::vector<std::string> texts;
  std::vector<std::vector<std::string>> shown;
  for (const Explanation& one : result_.explanations) {
    if (texts.size() == kMostShown) break;
    if (std::find(shown.begin(), shown.end(), one.mistakes) != shown.end()) continue;
    shown.push_back(one.mistakes);
    texts.push_back(fmt::format("{}: the program {}", one.method, listOf(one.sentences, "and")));
  }
  const std::int64_t last = result_.explanations.front().last_frame;
  result_.text +=
      fmt::format("\n{} (reproduces the frames{})", listOf(texts, "or, in these frames the same,"),
                  last == frames_.lastIndex() ? "" : fmt::format(" up to {}", last));
}

}  // namespace

FrameCheck checkFrames(const Scenario& scenario, const Particles& particles,
                       const std::vector<FrameText>& frames, const CheckOptions& options) {
  checkScenario(scenario);
  const AllFrames numbers = readFrames(frames, particles.state.size());
  return Checker(scenario, particles, numbers, options).check();
}

}  // namespace spring_pendulum

#include "check/check_frames.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

/// Work that a comparison with one method, or a search for mistakes, may take, in spring forces of the
/// library: some 10 s; and that of a search for mistakes that right frames do not show.
constexpr double kMostWork = 4e9;
constexpr double kMostDoubtWork = 4e8;

using Methods = std::vector<const Method*>;

/// Whether students write this method.
bool isExercise(const Method& method) {
  return method.hasFixedStep() && method.tableau != nullptr;
}

std::string listOf(const std::vector<std::string>& words, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? fmt::format(" {} ", last) : ", ";
    text += words[i];
  }
  return text;
}

class Checker {
 public:
  Checker(const Scenario& scenario, const Particles& particles, const AllFrames& frames,
          const CheckOptions& options)
      : scenario_(scenario),
        particles_(particles),
        frames_(frames),
        options_(options),
        chain_(scenario.chainOf(particles.masses)) {
    for (const Method& method : methodTable()) {
      const bool is_wanted = !options.method_is_given || &method == &scenario.method.get();
      (is_wanted ? wanted_ : others_).push_back(&method);
      if (isExercise(method)) (is_wanted ? wanted_exercise_ : other_exercise_).push_back(&method);
    }
    result_.remarks = frames.remarks;
    result_.frames = static_cast<std::int64_t>(frames.frames.size());
    result_.printed_digits = frames.digits;
  }

  FrameCheck check() {
    compareWith(wanted_);
    if (options_.stop && options_.stop())
      throw FileError("stopped before the frames were compared");
    if (result_.methods.empty() && result_.departure) {
      result_.verdict = FrameVerdict::kDifferent;
      explain();
      describeDifferent();
      return result_;
    }
    result_.departure.reset();
    // Programs differ by a frame or so in how they count.
    const std::int64_t wanted = scenario_.frames - 1;
    const bool has_end = result_.last_frame >= std::min(wanted - 2, wanted * 49 / 50);
    result_.verdict = has_end ? FrameVerdict::kEqual : FrameVerdict::kUndecided;
    if (!result_.methods.empty() && result_.last_frame > frames_.start) doubt();
    describeEqual();
    return result_;
  }

 private:
  /// Missing frames make each comparison slower, and tell nothing.
  WorkLimit limit() const {
    constexpr double kMostMissing = 30.0;  // for each frame that is there
    const auto there = static_cast<double>(result_.frames);
    const auto needed = static_cast<double>(frames_.lastIndex() + 1);
    return {kMostWork * std::min(1.0, kMostMissing * there / needed), options_.stop};
  }

  void compareWith(const Methods& methods) {
    std::size_t departing = 0;
    for (const Method* method : methods) {
      WorkLimit work = limit();
      if (work.isStopped()) return;
      const Agreement agreement = compare(
          frames_, [&] { return motionOf(*method, scenario_, particles_); }, work, &chain_);
      if (agreement.complete) {
        const bool is_best = agreement.last_frame > result_.last_frame;
        if (is_best) note(agreement);
        result_.methods.insert(is_best ? result_.methods.begin() : result_.methods.end(),
                               method->name);
      } else if (agreement.departure) {
        // The nearest one of those that students write, or the wanted one.
        const bool is_candidate = isExercise(*method) || methods.size() == 1;
        if (!is_candidate || (result_.departure && agreement.frames <= departing)) continue;
        departing = agreement.frames;
        noteDeparture(*method, agreement);
      }
    }
  }

  void note(const Agreement& agreement) {
    result_.last_frame = agreement.last_frame;
    result_.digits = frames_.digits;
    if (agreement.distance == 0.0 || agreement.scale == 0.0) return;
    const double largest_digit = std::floor(std::log10(agreement.scale));
    const double digits = largest_digit - std::log10(1.99 * agreement.distance) + 1.0;
    result_.digits = std::clamp(static_cast<int>(digits), 0, frames_.digits);
  }

  void noteDeparture(const Method& method, const Agreement& agreement) {
    if (&method != &scenario_.method.get() && options_.method_is_given) return;
    known_frames_ = agreement.frames;
    result_.nearest = method.name;
    result_.departure = agreement.departure;
    Scenario with_method = scenario_;
    with_method.method = method;
    result_.time = frameSteps(with_method).timeOfFrame(agreement.departure->frame);
  }

  /// Looks for mistakes in the wanted method, then for another method, then for mistakes in others.
  void explain() {
    if (!result_.departure->impossible.empty()) return;
    Search search{scenario_, particles_, frames_, known_frames_, limit()};
    const auto found = [&](std::vector<Explanation> explanations) {
      result_.explanations = std::move(explanations);
      return !result_.explanations.empty();
    };
    if (found(singleMistakes(search, wanted_exercise_))) return;
    compareWith(others_);
    if (!result_.methods.empty() && result_.last_frame > frames_.start) return;
    result_.methods.clear();
    if (found(singleMistakes(search, other_exercise_)) ||
        found(simplestMistakes(search, wanted_exercise_)) ||
        found(simplestMistakes(search, other_exercise_))) {
      return;
    }
    if (search.gave_up)
      result_.remarks.emplace_back("the search for mistakes stopped before all were tried");
  }

  /// Names mistakes that right frames would not show.
  void doubt() {
    const Method& best = findMethod(result_.methods.front());
    if (!isExercise(best)) return;
    Search search{scenario_, particles_, frames_, 0, {kMostDoubtWork, options_.stop}};
    std::vector<std::string> hidden;
    for (const Explanation& one : singleMistakes(search, {&best})) {
      const std::string& name = one.mistakes.back();
      if (std::find(hidden.begin(), hidden.end(), name) == hidden.end()) hidden.push_back(name);
    }
    constexpr std::size_t kMostNamed = 12;
    if (hidden.empty()) return;
    result_.remarks.push_back(
        hidden.size() > kMostNamed
            ? "these frames would show hardly any mistake; give more frames or digits, or another "
              "scene"
            : fmt::format("this scene and these digits would not show the mistakes {}",
                          fmt::join(hidden, ", ")));
  }

  std::string comparedText() const {
    const bool all = result_.last_frame == frames_.lastIndex();
    return fmt::format("{} to {} of {} printed",
                       all ? "all " + counted(result_.frames, "frame")
                           : fmt::format("frames up to {}", result_.last_frame),
                       result_.digits, counted(result_.printed_digits, "digit"));
  }

  void describeEqual() {
    if (result_.methods.empty()) {
      result_.text = fmt::format(
          "undecided: frame {} is the first one, and too late to be compared: rounding errors grow "
          "too much, or it takes too long",
          frames_.frames.front().index);
      return;
    }
    const bool all = result_.last_frame == frames_.lastIndex();
    const std::string rest = all ? ""
                                 : "; later frames are not compared: rounding errors grow too "
                                   "much, or it takes too long";
    const std::string equal =
        fmt::format("equal to {}: {}{}", result_.methods.front(), comparedText(), rest);
    result_.text = equal;
    if (result_.verdict == FrameVerdict::kUndecided) {
      result_.text = "undecided: " + equal;
      if (all) {
        result_.text += fmt::format("; the frames up to {} are missing (--frames {})",
                                    scenario_.frames - 1, scenario_.frames);
      }
    }
    if (result_.methods.size() > 1) {
      const std::vector<std::string> others(result_.methods.begin() + 1, result_.methods.end());
      result_.remarks.push_back(
          fmt::format("{} would look the same in these digits", listOf(others, "and")));
    }
  }

  /// "particle 2, by 6.9e-06 m along its spring to particle 1"
  std::string departureText() const {
    const Departure& departure = *result_.departure;
    if (!departure.impossible.empty()) return "which " + departure.impossible;
    if (!std::isfinite(departure.distance)) {
      return fmt::format("particle {}, where the frame has a number that is not finite",
                         departure.particle);
    }
    std::string text =
        fmt::format("particle {}, by {} m", departure.particle, roundedText(departure.distance, 2));
    if (departure.along_spring < 0.0) return text;
    constexpr double kMostly = 0.9;
    return text + (departure.along_spring > kMostly         ? " along its spring"
                   : departure.along_spring < 1.0 - kMostly ? " across its spring"
                                                            : "");
  }

  void describeDifferent() {
    result_.text =
        fmt::format("different: depart from {} at frame {}, t = {} s, {}", result_.nearest,
                    result_.departure->frame, roundedText(result_.time, 6), departureText());
    if (!result_.methods.empty()) {
      result_.text += fmt::format("\nThey are frames of {}: {}.", listOf(result_.methods, "or"),
                                  comparedText());
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
    result_.text += fmt::format("\n{} (reproduces the frames{})",
                                listOf(texts, "or, in these frames the same,"),
                                last == frames_.lastIndex() ? "" : fmt::format(" up to {}", last));
  }

  const Scenario& scenario_;
  const Particles& particles_;
  const AllFrames& frames_;
  const CheckOptions& options_;
  Chain chain_;
  Methods wanted_, others_;
  Methods wanted_exercise_, other_exercise_;  ///< of these, the ones that students write
  std::size_t known_frames_ = 0;              ///< number of frames before the departure
  FrameCheck result_;
};

}  // namespace

FrameCheck checkFrames(const Scenario& scenario, const Particles& particles,
                       const std::vector<FrameText>& frames, const CheckOptions& options) {
  checkScenario(scenario);
  const AllFrames numbers = readFrames(frames, particles);
  return Checker(scenario, particles, numbers, options).check();
}

}  // namespace spring_pendulum

#include "check/check_frames.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/simulation/frame_steps.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace spring_pendulum {
namespace {

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

/// "particle 2, by 6.9e-06 m along its spring"
std::string textOf(const Departure& departure) {
  constexpr double kMostly = 0.9;
  if (!departure.impossible.empty()) return "which " + departure.impossible;
  const std::string particle = fmt::format("particle {}, ", departure.particle);
  if (!std::isfinite(departure.distance))
    return particle + "where the frame has a number that is not finite";
  const bool has_spring = departure.along_spring >= 0.0;
  const bool is_across = has_spring && departure.along_spring < 1.0 - kMostly;
  return fmt::format("{}by {} m{}", particle, roundedText(departure.distance, 2),
                     departure.along_spring > kMostly ? " along its spring"
                     : is_across                      ? " across its spring"
                                                      : "");
}

class Checker {
 public:
  Checker(const Scenario& scenario, const Particles& particles, const AllFrames& frames,
          const CheckOptions& options)
      : scenario_(scenario), particles_(particles), frames_(frames), options_(options) {
    for (const Method& method : methodTable()) {
      const bool is_wanted = !options.method_is_given || &method == &scenario.method.get();
      (is_wanted ? wanted_ : others_).push_back(&method);
      if (isExercise(method))
        exercise_.insert(is_wanted ? exercise_.begin() : exercise_.end(), &method);
      if (isExercise(method) && is_wanted) wanted_exercise_.push_back(&method);
    }
    result_.remarks = frames.remarks;
    result_.frames = static_cast<std::int64_t>(frames.frames.size());
    result_.digits = frames.digits;
  }

  FrameCheck check() {
    compareWith(wanted_);
    if (options_.stop && options_.stop())
      throw FileError("stopped before the frames were compared");
    if (result_.methods.empty() && result_.departure) {
      result_.verdict = FrameVerdict::kDifferent;
      if (result_.departure->impossible.empty()) explain();
      describeDifferent();
      return result_;
    }
    result_.departure.reset();
    // Programs differ by a frame or so in how they count.
    const std::int64_t wanted = scenario_.frames - 1;
    const bool has_end = result_.last_frame >= std::min(wanted - 2, wanted * 49 / 50);
    if (has_end) result_.verdict = FrameVerdict::kEqual;
    if (result_.last_frame > frames_.start) nameHiddenMistakes();
    describeEqual();
    return result_;
  }

 private:
  /// Some 10 s. Missing frames make each comparison slower, and tell nothing.
  WorkLimit limit() const {
    constexpr double kMostWork = 4e9;
    constexpr double kMostMissing = 30.0;  // for each frame that is there
    const auto needed = static_cast<double>(frames_.frames.back().index + 1);
    const double share = kMostMissing * static_cast<double>(result_.frames) / needed;
    return {kMostWork * std::min(1.0, share), options_.stop};
  }

  /// Notes the methods that agree, and the departure from the nearest of those that students write, or
  /// from the only one.
  void compareWith(const Methods& methods) {
    const Chain chain = scenario_.chainOf(particles_.masses);
    for (const Method* method : methods) {
      WorkLimit work = limit();
      const Agreement agreement = compare(
          frames_, [&] { return motionOf(*method, scenario_, particles_); }, work, &chain);
      if (work.isStopped()) return;
      if (agreement.complete) {
        const bool is_best = agreement.last_frame > result_.last_frame;
        if (is_best) result_.last_frame = agreement.last_frame;
        result_.methods.insert(is_best ? result_.methods.begin() : result_.methods.end(),
                               method->name);
      } else if (agreement.departure && &methods == &wanted_ &&
                 (isExercise(*method) || methods.size() == 1) &&
                 (!result_.departure || agreement.frames > known_frames_ ||
                  (agreement.frames == known_frames_ &&
                   agreement.departure->distance < result_.departure->distance))) {
        known_frames_ = agreement.frames;
        result_.nearest = method->name;
        result_.departure = agreement.departure;
        Scenario with_method = scenario_;
        with_method.method = *method;
        result_.time = frameSteps(with_method).timeOfFrame(agreement.departure->frame);
      }
    }
  }

  /// Looks for mistakes in the wanted method, then for another method, then for mistakes in others.
  void explain() {
    Search search{scenario_, particles_, frames_, known_frames_, limit()};
    const auto found = [&](std::vector<Explanation> explanations) {
      result_.explanations = std::move(explanations);
      return !result_.explanations.empty();
    };
    if (found(singleMistakes(search, wanted_exercise_))) return;
    compareWith(others_);
    if (result_.last_frame > frames_.start) return;
    result_.methods.clear();
    if (found(simplestMistakes(search, exercise_)) || !search.gave_up) return;
    result_.remarks.emplace_back("the search for mistakes stopped before all were tried");
  }

  /// Names mistakes that right frames would not show.
  void nameHiddenMistakes() {
    constexpr double kMostWork = 4e8;
    constexpr std::size_t kMostNamed = 12;
    const Method& best = findMethod(result_.methods.front());
    if (!isExercise(best)) return;
    Search search{scenario_, particles_, frames_, 0, {kMostWork, options_.stop}};
    std::vector<std::string> hidden;
    for (const Explanation& one : singleMistakes(search, {&best})) {
      const std::string& name = one.mistakes.back();
      if (std::find(hidden.begin(), hidden.end(), name) == hidden.end()) hidden.push_back(name);
    }
    if (hidden.empty()) return;
    result_.remarks.push_back(
        hidden.size() > kMostNamed
            ? "these frames would show hardly any mistake; give more frames or digits, or another "
              "scene"
            : fmt::format("this scene and these digits would not show the mistakes {}",
                          fmt::join(hidden, ", ")));
  }

  bool isAllCompared() const { return result_.last_frame == frames_.frames.back().index; }

  std::string comparedText() const {
    return fmt::format("{} in the {} printed",
                       isAllCompared() ? "all " + counted(result_.frames, "frame")
                                       : fmt::format("frames up to {}", result_.last_frame),
                       counted(result_.digits, "digit"));
  }

  void describeEqual() {
    constexpr const char* kTooLate = "rounding errors grow too much, or it takes too long";
    result_.text = result_.verdict == FrameVerdict::kEqual ? "" : "undecided: ";
    if (result_.methods.empty()) {
      result_.text += fmt::format("frame {} is the first one, and too late to be compared: {}",
                                  frames_.frames.front().index, kTooLate);
      return;
    }
    result_.text += fmt::format("equal to {}: {}", result_.methods.front(), comparedText());
    if (!isAllCompared()) {
      result_.text += fmt::format("; later frames are not compared: {}", kTooLate);
    } else if (result_.verdict == FrameVerdict::kUndecided) {
      result_.text += fmt::format("; the frames up to {} are missing (--frames {})",
                                  scenario_.frames - 1, scenario_.frames);
    }
    if (result_.methods.size() == 1) return;
    const std::vector<std::string> others(result_.methods.begin() + 1, result_.methods.end());
    result_.remarks.push_back(listOf(others, "and") + " would look the same in these digits");
  }

  void describeDifferent() {
    result_.text = fmt::format("different: depart from {} at frame {}, t = {} s, {}\n",
                               result_.nearest, result_.departure->frame,
                               roundedText(result_.time, 6), textOf(*result_.departure));
    if (!result_.methods.empty()) {
      result_.text +=
          fmt::format("They are frames of {}: {}.", listOf(result_.methods, "or"), comparedText());
      return;
    }
    if (result_.explanations.empty()) {
      result_.text += "No known mistake reproduces them.";
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
        fmt::format("{} (reproduces the frames{})", listOf(texts, "or, in these frames the same,"),
                    last == frames_.frames.back().index ? "" : fmt::format(" up to {}", last));
  }

  const Scenario& scenario_;
  const Particles& particles_;
  const AllFrames& frames_;
  const CheckOptions& options_;
  Methods wanted_, others_;
  Methods exercise_, wanted_exercise_;  ///< of all and of these, the ones that students write
  std::size_t known_frames_ = 0;        ///< number of frames before the departure
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

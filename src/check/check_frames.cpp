#include "check/check_frames.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/mistakes.hpp"

namespace spring_pendulum {
namespace {

constexpr const char* kExercise[] = {"Euler", "Runge-Kutta-2", "Runge-Kutta-4"};

/// Methods of other courses, which are right only if they are asked for.
constexpr std::pair<const char*, ButcherTableau> kCourseMethods[] = {
    {"Heun", {2, {{{}, {1.0}}}, {0.5, 0.5}}}, {"Ralston", {2, {{{}, {2.0 / 3.0}}}, {0.25, 0.75}}}};

bool isOfCourse(const Method& method) {
  return std::any_of(std::begin(kCourseMethods), std::end(kCourseMethods),
                     [&](const auto& other) { return method.name == other.first; });
}

/// "particle 2, by 6.9e-06 m along its spring"
std::string textOf(const Departure& departure) {
  constexpr double kMostly = 0.9;
  if (!departure.impossible.empty()) return "which " + departure.impossible;
  const std::string particle = fmt::format("particle {}, ", departure.particle);
  if (!std::isfinite(departure.distance))
    return particle + "where the frame has a number that is not finite";
  const double along = departure.along_spring;
  return fmt::format("{}by {} m{}", particle, roundedText(departure.distance, 2),
                     along > kMostly                       ? " along its spring"
                     : along >= 0 && along < 1.0 - kMostly ? " across its spring"
                                                           : "");
}

class Checker {
 public:
  Checker(const Scenario& scenario, const Scene& particles, AllFrames frames,
          const CheckOptions& options)
      : scenario_(scenario), particles_(particles), frames_(std::move(frames)), options_(options) {
    for (const Method& method : methodTable()) {
      const bool is_wanted =
          options.method_is_given ? &method == &scenario.method.get() : !isOfCourse(method);
      (is_wanted ? wanted_ : others_).push_back(&method);
      if (is_wanted && StudentProgram::isWritten(method))
        wanted_written_.insert(wanted_written_.begin(), &method);
    }
    result_.frames = static_cast<std::int64_t>(frames_.frames.size());
    result_.digits = frames_.digits;
  }

  FrameCheck check() {
    compareWith(wanted_);
    if (result_.methods.empty() && frames_.renumber(particles_.state.positions())) {
      result_.departure.reset();
      compareWith(wanted_);
    }
    if (options_.stop && options_.stop())
      throw FileError("stopped before the frames were compared");
    result_.remarks = frames_.remarks;
    if (result_.methods.empty() && result_.departure) {
      if (result_.departure->impossible.empty()) explain();
      describeDifferent();
      return result_;
    }
    result_.departure.reset();
    // Programs differ by a frame or so in how they count.
    const std::int64_t wanted = scenario_.frames - 1;
    if (result_.last_frame >= std::min(wanted - 2, wanted * 49 / 50))
      result_.verdict = FrameVerdict::kEqual;
    describeEqual();
    return result_;
  }

 private:
  static constexpr double kMostWork = 4e9;  ///< some 10 s

  /// Notes the methods that agree, and the departure from the nearest of those that students write, or
  /// from the only one.
  void compareWith(const Methods& methods) {
    const Chain chain = Chain(particles_.masses, scenario_.constants);
    for (const Method* method : methods) {
      WorkLimit work{kMostWork, options_.stop};
      const Agreement agreement = compare(
          frames_, [&] { return motionOf(*method, scenario_, particles_); }, work, &chain);
      if (work.isStopped()) return;
      if (agreement.complete) {
        const bool is_best = agreement.last_frame > result_.last_frame;
        if (is_best) result_.last_frame = agreement.last_frame;
        result_.methods.insert(is_best ? result_.methods.begin() : result_.methods.end(),
                               method->name);
      } else if (agreement.departure && &methods == &wanted_ &&
                 (StudentProgram::isWritten(*method) || methods.size() == 1)) {
        noteDeparture(*method, agreement);
      }
    }
  }

  void noteDeparture(const Method& method, const Agreement& agreement) {
    const bool is_nearer = !result_.departure || agreement.frames > known_frames_ ||
                           (agreement.frames == known_frames_ &&
                            agreement.departure->distance < result_.departure->distance);
    if (!is_nearer) return;
    known_frames_ = agreement.frames;
    result_.nearest = method.name;
    result_.departure = agreement.departure;
    Plan with_method = scenario_;
    with_method.method = method;
    result_.time = with_method.timeOfFrame(agreement.departure->frame);
  }

  /// Looks for mistakes in the wanted method, then for another method, then for mistakes in others.
  void explain() {
    Search search{scenario_, particles_, frames_, known_frames_, {kMostWork, options_.stop}};
    result_.explanations = findMistakes(search, wanted_written_, true);
    if (!result_.explanations.empty()) return;
    compareWith(others_);
    if (result_.last_frame > frames_.start) return;
    result_.methods.clear();
    Methods written = wanted_written_;
    for (const char* const name : kExercise) {
      const Method* const method = &findMethod(name);
      if (std::find(wanted_.begin(), wanted_.end(), method) == wanted_.end())
        written.push_back(method);
    }
    result_.explanations = findMistakes(search, written);
    if (search.gave_up && result_.explanations.empty())
      result_.remarks.emplace_back("the search for mistakes stopped before all were tried");
  }

  std::string comparedText() const {
    const bool has_all = result_.last_frame == frames_.frames.back().index;
    return fmt::format("{} in the {} printed",
                       has_all ? "all " + counted(result_.frames, "frame")
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
    if (result_.last_frame != frames_.frames.back().index) {
      result_.text += fmt::format("; later frames are not compared: {}", kTooLate);
    } else if (result_.verdict == FrameVerdict::kUndecided) {
      result_.text += fmt::format("; the frames up to {} are missing (--frames {})",
                                  scenario_.frames - 1, scenario_.frames);
    }
    if (result_.methods.size() == 1) return;
    result_.remarks.push_back(
        fmt::format("{} would look the same in these digits",
                    fmt::join(result_.methods.begin() + 1, result_.methods.end(), " and ")));
  }

  void describeDifferent() {
    result_.verdict = FrameVerdict::kDifferent;
    result_.text = fmt::format("different: depart from {} at frame {}, t = {} s, {}\n",
                               result_.nearest, result_.departure->frame,
                               roundedText(result_.time, 6), textOf(*result_.departure));
    if (!result_.methods.empty()) {
      result_.text += fmt::format("They are frames of {}: {}.", fmt::join(result_.methods, " or "),
                                  comparedText());
      return;
    }
    if (result_.explanations.empty()) {
      result_.text += "No known mistake reproduces them.";
      return;
    }
    constexpr std::size_t kMostShown = 3;
    std::vector<std::string> texts;
    for (const Explanation& one : result_.explanations) {
      if (texts.size() == kMostShown) break;
      texts.push_back(
          fmt::format("{}: the program {}", one.method, fmt::join(one.sentences, " and ")));
    }
    const std::int64_t last = result_.explanations.front().last_frame;
    result_.text += fmt::format(
        "{} (reproduces the frames{})", fmt::join(texts, " or, in these frames the same, "),
        last == frames_.frames.back().index ? "" : fmt::format(" up to {}", last));
  }

  const Scenario& scenario_;
  const Scene& particles_;
  AllFrames frames_;
  const CheckOptions& options_;
  Methods wanted_, others_;
  Methods wanted_written_;        ///< those that students write
  std::size_t known_frames_ = 0;  ///< number of frames before the departure
  FrameCheck result_;
};

/// \param text without control characters except the end of a line
std::string inJson(std::string_view text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c == '\n' ? "\\n" : std::string(1, c);
  }
  return '"' + quoted + '"';
}

/// A list of what a function makes of each item.
template <typename Items, typename Function>
std::string listInJson(const Items& items, const Function& function) {
  std::string list;
  for (const auto& item : items) list += (list.empty() ? "" : ", ") + function(item);
  return '[' + list + ']';
}

std::string departureInJson(const FrameCheck& check) {
  if (!check.departure) return "null";
  const Departure& departure = *check.departure;
  return fmt::format(R"({{"from": {}, "frame": {}, "time": {}, "particle": {}, "distance": {}}})",
                     inJson(check.nearest), departure.frame, numberText(check.time),
                     departure.particle,
                     std::isfinite(departure.distance) ? numberText(departure.distance) : "null");
}

std::string conclusionOf(const FrameCheck& check) {
  const std::string method = check.methods.empty() ? "" : check.methods.front();
  if (check.verdict == FrameVerdict::kEqual) return "equal to " + method;
  if (check.verdict == FrameVerdict::kUndecided)
    return fmt::format("undecided: equal to {} up to frame {}", method, check.last_frame);
  if (!method.empty()) return "different: frames of " + method;
  if (check.explanations.empty()) {
    return fmt::format("different from frame {} on, no known mistake", check.departure->frame);
  }
  const Explanation& first = check.explanations.front();
  return fmt::format("different: {} with {}", first.method, fmt::join(first.mistakes, " + "));
}

}  // namespace

void registerCourseMethods() {
  for (const auto& [name, tableau] : kCourseMethods) {
    Method method = methodOfTableau(name, tableau);
    method.use = "of other courses: right only if it is asked for";
    registerMethod(method);
  }
}

FrameCheck checkFrames(const Scenario& scenario, const Scene& particles,
                       const std::vector<FrameText>& frames, const CheckOptions& options) {
  checkScenario(scenario);
  return Checker(scenario, particles, readFrames(frames, particles), options).check();
}

std::string reportOf(const FrameCheck& check) {
  std::string report = check.text + "\n";
  for (const std::string& remark : check.remarks) report += "note: " + remark + "\n";
  return report;
}

std::string shortReportOf(const FrameCheck& check) {
  std::string report = conclusionOf(check);
  for (const std::string& remark : check.remarks) report += "; note: " + remark;
  return report;
}

std::string jsonOf(const FrameCheck& check, const std::string& folder) {
  const auto explanation = [](const Explanation& one) {
    return fmt::format(R"({{"method": {}, "mistakes": {}, "sentences": {}, "last_frame": {}}})",
                       inJson(one.method), listInJson(one.mistakes, inJson),
                       listInJson(one.sentences, inJson), one.last_frame);
  };
  return fmt::format(
      R"({{"folder": {}, "equal": {}, "undecided": {}, "methods": {}, "frames": {}, )"
      R"("last_frame": {}, "digits": {}, "departure": {}, )"
      R"("explanations": {}, "remarks": {}, "text": {}}})"
      "\n",
      inJson(onOneLine(folder)), check.verdict == FrameVerdict::kEqual,
      check.verdict == FrameVerdict::kUndecided, listInJson(check.methods, inJson), check.frames,
      check.last_frame, check.digits, departureInJson(check),
      listInJson(check.explanations, explanation), listInJson(check.remarks, inJson),
      inJson(check.text));
}

std::string jsonOfError(const std::string& message, const std::string& folder) {
  return fmt::format("{{\"folder\": {}, \"error\": {}}}\n", inJson(onOneLine(folder)),
                     inJson(message));
}

std::string listOfMistakes() {
  std::string list = "The program ...\n";
  for (const Mistake& mistake : knownMistakes())
    list += fmt::format("  {:<22} {}\n", mistake.name, mistake.sentence);
  list += "Fitted numbers: the program ...\n";
  for (const Constant& constant : fittedConstants())
    list += fmt::format("  {:<22} {}\n", constant.name, constant.sentence);
  return list;
}

}  // namespace spring_pendulum

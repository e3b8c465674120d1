#include "check/check_frames.hpp"

#include "base/numbers.hpp"
#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "check/search.hpp"

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

class Checker {
 public:
  Checker(const Scenario& scenario, const Scene& particles, AllFrames frames,
          const CheckOptions& options)
      : scenario_(scenario), particles_(particles), frames_(std::move(frames)), options_(options) {
    for (const Method& method : methodTable()) {
      const bool is_wanted =
          options.method_is_given ? &method == &scenario.method.get() : !isOfCourse(method);
      (is_wanted ? wanted_ : others_).push_back(&method);
      if (is_wanted && kindOf(method) != 0)
        wanted_written_.insert(wanted_written_.begin(), &method);
    }
  }

  FrameCheck check() {
    compareWith(wanted_);
    if (methods_.empty() && frames_.renumber(particles_.state.positions())) {
      departure_.reset();
      compareWith(wanted_);
    }
    if (options_.stop && options_.stop())
      throw FileError("stopped before the frames were compared");
    FrameCheck result;
    result.notes = frames_.notes;
    methods_.empty() && departure_ ? describeDifferent(result) : describeEqual(result);
    return result;
  }

 private:
  static constexpr double kMostWork = 10.0;  ///< s

  /// Notes the methods that agree, and the departure from the nearest of those that students write, or
  /// from the only one.
  void compareWith(const Methods& methods) {
    const Chain chain(particles_.masses, scenario_.constants);
    for (const Method* method : methods) {
      Plan plan = scenario_;
      plan.method = *method;
      WorkLimit work{kMostWork / static_cast<double>(methods.size()), options_.stop};
      const Agreement agreement = compare(
          frames_, [&] { return motionOf(plan, chain, particles_); }, work, &chain);
      if (work.isStopped()) return;
      if (agreement.complete) {
        if (agreement.last_frame > last_frame_) methods_.clear();
        last_frame_ = std::max(last_frame_, agreement.last_frame);
        if (agreement.last_frame == last_frame_) methods_.push_back(method->name);
      } else if (agreement.departure && &methods == &wanted_ &&
                 (kindOf(*method) != 0 || methods.size() == 1)) {
        noteDeparture(plan, agreement);
      }
    }
  }

  void noteDeparture(const Plan& plan, const Agreement& agreement) {
    const bool is_nearer =
        !departure_ || agreement.frames > known_frames_ ||
        (agreement.frames == known_frames_ && agreement.departure->distance < departure_->distance);
    if (!is_nearer) return;
    known_frames_ = agreement.frames;
    departure_ = agreement.departure;
    nearest_ = plan;
  }

  /// Looks for mistakes in the wanted method, then for another method, then for mistakes in others.
  std::vector<Explanation> explain(FrameCheck& result) {
    Search search{scenario_, particles_, frames_, known_frames_, {kMostWork, options_.stop}};
    std::vector<Explanation> found = findMistakes(search, wanted_written_, true);
    if (!found.empty()) return found;
    compareWith(others_);
    if (last_frame_ > frames_.start) return found;
    methods_.clear();
    Methods written = wanted_written_;
    for (const char* const name : kExercise) {
      const Method* const method = &findMethod(name);
      if (std::find(wanted_.begin(), wanted_.end(), method) == wanted_.end())
        written.push_back(method);
    }
    found = findMistakes(search, written);
    if (search.gave_up && found.empty())
      result.notes.emplace_back("the search for mistakes stopped before all were tried");
    return found;
  }

  std::string comparedText() const {
    const auto count = static_cast<std::int64_t>(frames_.frames.size());
    const bool has_all = last_frame_ == frames_.frames.back().index;
    return fmt::format(
        "{} in the {} printed",
        has_all ? "all " + counted(count, "frame") : fmt::format("frames up to {}", last_frame_),
        counted(frames_.digits, "digit"));
  }

  void describeEqual(FrameCheck& result) const {
    constexpr const char* kTooLate = "rounding errors grow too much, or it takes too long";
    const std::int64_t last = scenario_.frames - 1;
    // Programs differ by a frame or so in how they count.
    const bool has_last = last_frame_ >= std::max(std::min(last, frames_.start + 1),
                                                  std::min(last - 2, last * 49 / 50));
    result.verdict = has_last ? FrameVerdict::kEqual : FrameVerdict::kUndecided;
    result.result = has_last ? "" : "undecided: ";
    if (methods_.empty()) {
      result.result += fmt::format("frame {} is the first one, and too late to be compared: {}",
                                   frames_.frames.front().index, kTooLate);
      return;
    }
    result.result += fmt::format("equal to {}: {}", methods_.front(), comparedText());
    if (last_frame_ != frames_.frames.back().index) {
      result.result += fmt::format("; later frames are not compared: {}", kTooLate);
    } else if (!has_last) {
      result.result +=
          fmt::format("; the frames up to {} are missing (--frames {})", last, scenario_.frames);
    }
    if (methods_.size() == 1) return;
    result.notes.push_back(fmt::format("{} would look the same in these digits",
                                       fmt::join(methods_.begin() + 1, methods_.end(), " and ")));
  }

  void describeDifferent(FrameCheck& result) {
    constexpr std::size_t kMostShown = 3;
    const std::vector<Explanation> found =
        departure_->is_compared ? explain(result) : std::vector<Explanation>{};
    result.verdict = FrameVerdict::kDifferent;
    result.departure_time = nearest_.timeOfFrame(departure_->frame);
    result.details = {fmt::format("depart from {} at frame {}, t = {} s, {}",
                                  nearest_.method.get().name, departure_->frame,
                                  roundedText(*result.departure_time, 6), departure_->text)};
    result.result = "different: no known mistake reproduces the frames";
    if (!methods_.empty())
      result.result =
          fmt::format("different: frames of {}: {}", fmt::join(methods_, " or "), comparedText());
    for (std::size_t i = 0; i < std::min(found.size(), kMostShown); ++i) {
      const auto& [program, last] = found[i];
      const std::string& method = program.method.get().name;
      if (i == 0)
        result.result =
            fmt::format("different: {} with {}", method, fmt::join(program.mistakes, " + "));
      result.details.push_back(
          fmt::format("{}{}: the program {} (reproduces the frames{})", i == 0 ? "" : "or ", method,
                      fmt::join(program.sentences, " and "),
                      last == frames_.frames.back().index ? "" : fmt::format(" up to {}", last)));
    }
  }

  const Scenario& scenario_;
  const Scene& particles_;
  AllFrames frames_;
  const CheckOptions& options_;
  Methods wanted_, others_;
  Methods wanted_written_;            ///< those that students write
  std::vector<std::string> methods_;  ///< those that the frames equal longest
  std::int64_t last_frame_ = -1;      ///< the last one that could be compared
  std::size_t known_frames_ = 0;      ///< number of frames before the departure
  std::optional<Departure> departure_;
  Plan nearest_;  ///< with the method from which the frames depart
};

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
  std::string report = check.result + "\n";
  for (const std::string& line : check.details) report += line + "\n";
  for (const std::string& note : check.notes) report += "note: " + note + "\n";
  return report;
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

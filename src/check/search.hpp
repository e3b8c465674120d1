// Searches for the mistakes that reproduce frames.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "check/comparison.hpp"
#include "check/mistakes.hpp"

namespace spring_pendulum {

/// Mistakes that together reproduce the frames.
struct Explanation {
  std::string method;                  ///< the method in which they are made
  std::vector<std::string> mistakes;   ///< short names: "heun", "g"
  std::vector<std::string> sentences;  ///< for the student, one per mistake: "uses g = 10 m/s²"
  std::int64_t last_frame = 0;         ///< reproduced up to this frame
};

class MistakeSearch {
 public:
  /// \param known_frames number of leading frames without a sign of a mistake
  MistakeSearch(const Scenario& scenario, const Particles& particles, const AllFrames& frames,
                std::size_t known_frames, WorkLimit limit)
      : scenario_(scenario),
        particles_(particles),
        frames_(frames),
        known_frames_(known_frames),
        limit_(std::move(limit)) {}

  /// Returns the mistakes that each explain the frames, without fits: the fast part.
  std::vector<Explanation> singleMistakes(const std::vector<const Method*>& methods);

  /// Returns the simplest explanations: a wrong number, float, two mistakes, or a mistake and a wrong
  /// number.
  std::vector<Explanation> search(const std::vector<const Method*>& methods);

  /// Whether the search ended before everything was tried.
  bool gaveUp() const { return gave_up_; }

 private:
  struct Candidate;

  Candidate rightProgram(const Method& method) const;
  void tryMistakes(const Candidate& base) { tryMistakesFrom(0, base); }
  void tryMistakesFrom(std::size_t first, const Candidate& base);
  void tryConstants(const Candidate& base);
  void trySinglePrecision(const Candidate& base);
  void tryTwoMistakes(const Candidate& base);
  void tryMistakeAndConstant(const Candidate& base);

  bool isOver();
  /// Whether an explanation reproduces all frames, or many that show the mistake.
  bool isStrong(const Explanation& explanation) const;
  bool explains(const Candidate& candidate, std::int64_t* last_frame = nullptr);
  Agreement agreementOf(const Candidate& candidate);
  /// Fits a constant, starting from its value times `factor`.
  bool fit(Candidate candidate, const Constant& constant, double factor = 1.0);
  /// One step of the secant method over the leading frames of a window.
  bool improve(StudentProgram& program, const Constant& constant, std::size_t window);

  const Scenario& scenario_;
  const Particles& particles_;
  const AllFrames& frames_;
  std::size_t known_frames_;
  WorkLimit limit_;
  bool gave_up_ = false;
  std::vector<Explanation> found_;
};

}  // namespace spring_pendulum

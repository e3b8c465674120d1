// Searches for the mistakes that reproduce frames.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "check/comparison.hpp"
#include "check/mistakes.hpp"

namespace spring_pendulum {

class MistakeSearch {
 public:
  /// \param known_frames number of leading frames without a sign of a mistake
  MistakeSearch(const Scenario& scenario, const Particles& particles, const AllFrames& frames,
                std::size_t known_frames, WorkLimit limit);

  /// Returns the mistakes in a method that each explain the frames, without fits: the fast part.
  std::vector<Explanation> singleMistakes(const Method& method);

  /// Returns the simplest explanations: one wrong number, single precision, two mistakes, ...
  /// \param methods groups of methods; one is searched only if no group before explains the frames
  std::vector<Explanation> search(const std::vector<std::vector<const Method*>>& methods);

  /// Whether the search ended before everything was tried.
  bool gaveUp() const { return gave_up_; }

 private:
  struct Candidate;
  using Level = void (MistakeSearch::*)(const Candidate&);

  Candidate rightProgram(const Method& method) const;
  void tryMistakes(const Candidate& base);
  void tryConstants(const Candidate& base);
  void trySinglePrecision(const Candidate& base);
  void tryTwoMistakes(const Candidate& base);
  void tryMistakeAndConstant(const Candidate& base);
  void tryCoefficients(const Candidate& base);
  void trySinglePrecisionAndMistake(const Candidate& base);
  void tryMistakeAndCoefficient(const Candidate& base);
  void tryWeights(const Candidate& base);
  void tryMistakeAndWeights(const Candidate& base);
  /// Calls a function with each mistake added to the candidate.
  template <typename Function>
  void tryWithMistakes(const Candidate& base, const Function& try_one);

  bool isOver();
  /// Whether an explanation reproduces all frames, or many that show the mistake.
  bool isStrong(const Explanation& explanation) const;
  /// Whether all frames agree, also beyond those that show no mistake.
  bool isConvincing(const Agreement& agreement);
  bool explains(const Candidate& candidate);
  Agreement agreementOf(const Candidate& candidate);
  void keep(const Candidate& candidate, std::int64_t last_frame);
  /// Fits constants of a candidate, starting from their values times `factor`.
  bool fit(Candidate candidate, const std::vector<const Constant*>& constants, double factor);
  /// Rounds fitted constants to the fewest digits with which they still explain the frames.
  void roundConstants(Candidate& candidate, const std::vector<const Constant*>& constants);

  const Scenario& scenario_;
  const Particles& particles_;
  const AllFrames& frames_;
  std::size_t known_frames_;
  WorkLimit limit_;
  bool gave_up_ = false;
  std::vector<Explanation> found_;
};

}  // namespace spring_pendulum

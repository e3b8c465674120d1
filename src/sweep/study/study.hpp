// A study: a base scenario, axes that vary it, random masses and starts, the columns wanted.
//
// Case i is a function of the study and i alone. The last axis varies fastest, the samples slowest.
// Cases of one sample have the same random masses and starts: methods are compared on the same scenes.
#pragma once

#include "simulation/options/scenario_options.hpp"
#include <spring_pendulum/simulation/scenario.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum::sweep {

struct Column;

/// Returns the hash FNV-1a of a text that continues a text with the hash `hash` (RFC 9923).
inline std::uint64_t hashOf(std::string_view text, std::uint64_t hash = 0xcbf29ce484222325) {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

constexpr double kMostCases = 1e9;

/// What a case has besides the options of a run.
struct Settings {
  Scenario scenario;
  /// Simulated time in s, at which every case ends. If above 0, it gives the number of frames, at most
  /// `frame_interval` s apart (or a step, if that is longer), and for fixed steps the steps per frame.
  double duration = 0.0;
  double mass_factor = 1.0;  ///< for all masses
};

/// Returns the time step, in s, or if its multiples do not end at the duration, a shorter one.
double fittedTimeStep(const Settings& settings, double time_step);

/// The options of a case, bound to `settings`.
std::vector<Option> caseOptions(Settings& settings);

struct Distribution {
  double first = 0.0;   ///< the only value; least value, mean or median of a given distribution
  double second = 0.0;  ///< most value, or standard deviation (of the logarithm)
  bool is_given = false;
  bool is_log = false;    ///< of the logarithm
  bool is_range = false;  ///< uniform instead of normal
};

struct Axis {
  std::string key;
  std::string unit;
  std::vector<std::string> values;  ///< as Exercise3 takes them
  bool is_joined = false;           ///< to the axis before: both take their n-th value at once
};

/// Where a case is in a study.
struct Place {
  std::vector<std::string> values;  ///< of the axes
  std::int64_t sample = 0;
};

struct Study {
  std::string name;  ///< of the file, without folder and extension
  Settings base;
  std::vector<Axis> axes;
  std::int64_t seed = 0;
  std::int64_t samples = 0;       ///< 0: nothing is random
  Distribution mass_factor{1.0};  ///< of each particle
  Distribution displacement;      ///< of each particle in x and in y, m
  Distribution velocity;          ///< added to that of each particle in x and in y, m/s
  std::vector<const Column*> columns;
  std::vector<std::string> plot;           ///< arguments of the script that draws the table
  std::map<std::string, Scene> particles;  ///< content of each particle file
  std::uint64_t hash = 0;                  ///< of the study and its particle files

  std::int64_t cases() const;
  Place placeOf(std::int64_t index) const;
  /// Whether cases have particles that are in no file.
  bool changesParticles(const Settings& settings) const;
};

/// Reads a study and its particle files. Paths of particle files are relative to the study.
/// \throws FileError, and InputError with file and line
Study readStudy(const std::string& path);

/// One case of a study.
struct Case {
  std::int64_t sample = 0;
  Settings settings;
  Scene particles;  ///< as a particle file would give them

  Scene scene() const { return makeScene(settings.scenario, particles); }
};

/// Returns case 0 <= index < study.cases().
/// \throws InputError for a mass out of range and a time step that does not end at the duration; `Run`
/// checks the scenario
Case caseOf(const Study& study, std::int64_t index);

}  // namespace spring_pendulum::sweep

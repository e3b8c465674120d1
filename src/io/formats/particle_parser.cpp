#include "io/formats/particle_parser.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace spring_pendulum {
namespace {

/// Removes and returns the first word of a line; empty at its end.
std::string_view nextWord(std::string_view& line) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  std::size_t begin = 0;
  while (begin < line.size() && is_blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !is_blank(line[end])) ++end;
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

/// Returns a line without its carriage return and its comment.
std::string_view contentOf(std::string_view line) {
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line.substr(0, line.find('#'));
}

}  // namespace

std::string_view ParticleParser::nextLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

void ParticleParser::parse(std::string_view lines) {
  while (!lines.empty()) parseLine(nextLine(lines));
}

void ParticleParser::parseLine(std::string_view line) {
  ++line_number_;
  line = contentOf(line);
  std::array<double, kColumnsWithVelocity> numbers{};
  std::size_t columns = 0;
  for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
    if (columns < numbers.size()) numbers[columns] = parseWord(word);
    ++columns;
  }
  if (columns == 0) return;
  checkColumns(columns);
  const Row row{numbers[0], numbers[1], numbers[2]};
  if (!rows_.empty()) checkMovingParticle(row);
  rows_.push_back(row);
  if (columns == kColumnsWithVelocity) velocities_.push_back({numbers[3], numbers[4]});
  last_line_ = line_number_;
}

Scene ParticleParser::particles(bool keep_negative_zeros) const {
  if (rows_.empty()) {
    throw InputError(fmt::format("{}: no particles; write one line 'x y m' per particle", name_));
  }
  const auto size = static_cast<Eigen::Index>(rows_.size());
  Scene result{AlignedNumbers(size), State(size)};
  const double zero = keep_negative_zeros ? -0.0 : 0.0;  // x + -0.0 is x, -0.0 + 0.0 is 0.0
  for (Eigen::Index i = 0; i < size; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    result.state.x()[i] = row[0] + zero;
    result.state.y()[i] = row[1] + zero;
    result.masses[i] = row[2];
    if (velocities_.empty()) continue;
    const auto& velocity = velocities_[static_cast<std::size_t>(i)];
    result.state.vx()[i] = velocity[0] + zero;
    result.state.vy()[i] = velocity[1] + zero;
  }
  return result;
}

double ParticleParser::parseWord(std::string_view word) const {
  const std::optional<double> value = parseNumber(word);
  if (!value) {
    const bool has_comma = word.find(',') != std::string_view::npos;
    refuse(fmt::format("{} is not a number; {}", inQuotes(word),
                       has_comma ? "use a decimal point, and spaces between numbers"
                                 : "write a finite number such as 0.5 or -2e-3"));
  }
  return *value;
}

void ParticleParser::checkColumns(std::size_t columns) const {
  const bool with_velocity = columns == kColumnsWithVelocity;
  if (columns != kColumns && !with_velocity) {
    refuse(counted(static_cast<std::int64_t>(columns), "number") +
           " in this line; a particle needs 3: x y m, or 5: x y m vx vy");
  }
  if (rows_.empty() || with_velocity == hasVelocities()) return;
  refuse(
      fmt::format("{} velocity, but the particle in line {} has {}; give vx vy for all "
                  "particles or for none",
                  with_velocity ? "has a" : "has no", last_line_, with_velocity ? "none" : "one"));
}

void ParticleParser::checkMovingParticle(const Row& row) const {
  const double mass = row[2];
  if (!(mass > 0.0))
    refuse(fmt::format("mass must be positive, got {} kg", numberText(mass + 0.0)));
  if (!std::isfinite(1.0 / mass))
    refuse(fmt::format("mass must be large enough for 1/mass to be finite, got {} kg",
                       numberText(mass)));
  const double dx = row[0] - rows_.back()[0];
  const double dy = row[1] - rows_.back()[1];
  const double square = dx * dx + dy * dy;
  if (std::isnormal(square)) return;
  refuse(std::isfinite(square)
             ? fmt::format("same position as the particle in line {}; neighbours must not coincide",
                           last_line_)
             : fmt::format("too far from the particle in line {}; the square of their distance "
                           "must be finite",
                           last_line_));
}

void ParticleParser::refuse(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", name_, line_number_, what));
}

}  // namespace spring_pendulum

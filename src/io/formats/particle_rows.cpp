#include "io/formats/particle_rows.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/files/posix.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr std::size_t kColumns = 3;
constexpr std::size_t kColumnsWithVelocity = 5;

/// Removes and returns the first word of a line; empty at its end.
std::string_view nextWord(std::string_view& line) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };  // find_first_of() is slow
  const char* const begin = std::find_if_not(line.data(), line.data() + line.size(), is_blank);
  const char* const end = std::find_if(begin, line.data() + line.size(), is_blank);
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return {begin, static_cast<std::size_t>(end - begin)};
}

/// Removes and returns the first line of a text, without its end and its comment.
std::string_view nextLine(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line.substr(0, line.find('#'));
}

class RowParser {
 public:
  RowParser(std::string_view name, bool is_state) : name_(name), is_state_(is_state) {}

  void parseLine(std::string_view line) {
    ++line_number_;
    std::array<double, kColumnsWithVelocity> row{};
    std::size_t columns = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      if (columns < row.size()) row[columns] = parseWord(word);
      ++columns;
    }
    if (columns == 0) return;
    checkColumns(columns);
    if (!numbers_.empty())
      checkMovingParticle(row.data(), numbers_.data() + numbers_.size() - columns);
    columns_ = columns;
    numbers_.insert(numbers_.end(), row.data(), row.data() + columns);
    last_line_ = line_number_;
  }

  ParticleRows rows() const {
    if (columns_ == 0)
      throw InputError(fmt::format("{}: no particles; write one line 'x y m' per particle", name_));
    using Table = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Table> table(numbers_.data(),
                                        static_cast<Eigen::Index>(numbers_.size() / columns_),
                                        static_cast<Eigen::Index>(columns_));
    ParticleRows rows{{AlignedNumbers(table.rows()), State(table.rows())},
                      columns_ == kColumnsWithVelocity};
    const double zero = is_state_ ? -0.0 : 0.0;  // x + -0.0 is x, -0.0 + 0.0 is 0.0
    State& state = rows.particles.state;
    rows.particles.masses.view() = table.col(2);
    state.x() = table.col(0) + zero;
    state.y() = table.col(1) + zero;
    if (!rows.have_velocities) return rows;
    state.vx() = table.col(3) + zero;
    state.vy() = table.col(4) + zero;
    state.velocities().row(0).setZero();  // the first particle is fixed
    return rows;
  }

 private:
  double parseWord(std::string_view word) const {
    const std::optional<double> value = parseNumber(word);
    if (value) return *value;
    const bool has_comma = word.find(',') != std::string_view::npos;
    refuse(fmt::format("{} is not a number; {}", inQuotes(word),
                       has_comma ? "use a decimal point, and spaces between numbers"
                                 : "write a finite number such as 0.5 or -2e-3"));
  }

  void checkColumns(std::size_t columns) const {
    const bool with_velocity = columns == kColumnsWithVelocity;
    if (columns != kColumns && !with_velocity)
      refuse(counted(static_cast<std::int64_t>(columns), "number") +
             " in this line; a particle needs 3: x y m, or 5: x y m vx vy");
    if (numbers_.empty() || columns == columns_) return;
    refuse(fmt::format(
        "{} velocity, but the particle in line {} has {}; give vx vy for all particles or for none",
        with_velocity ? "has a" : "has no", last_line_, with_velocity ? "none" : "one"));
  }

  void checkMovingParticle(const double* row, const double* before) const {
    const double mass = row[2];
    if (!(mass > 0.0))
      refuse(fmt::format("mass must be positive, got {} kg", numberText(mass + 0.0)));
    if (!std::isfinite(1.0 / mass)) {
      refuse(fmt::format("mass must be large enough for 1/mass to be finite, got {} kg",
                         numberText(mass)));
    }
    const double dx = row[0] - before[0];
    const double dy = row[1] - before[1];
    const double square = dx * dx + dy * dy;
    if (is_state_ ? std::isfinite(square) : std::isnormal(square)) return;
    refuse(
        fmt::format(std::isfinite(square)
                        ? "same position as the particle in line {}; neighbours must not coincide"
                        : "too far from the particle in line {}; the square of their distance "
                          "must be finite",
                    last_line_));
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_number_, what));
  }

  std::string_view name_;
  bool is_state_;
  std::vector<double> numbers_;  ///< of all rows
  std::size_t columns_ = 0;      ///< of a row
  std::int64_t line_number_ = 0;
  std::int64_t last_line_ = 0;  ///< line of the last particle
};

}  // namespace

ParticleRows parseRows(std::string_view text, std::string_view name, bool is_state) {
  RowParser parser(name, is_state);
  while (!text.empty()) parser.parseLine(nextLine(text));
  return parser.rows();
}

Scene parseParticles(std::string_view text, std::string_view name) {
  return parseRows(text, name).particles;
}

Scene readParticleFile(const std::string& path) {
  return parseParticles(readTextFile(path), path);
}

}  // namespace spring_pendulum

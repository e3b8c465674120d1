#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "io/files/text_file.hpp"
#include <spring_pendulum/base/errors.hpp>
#include <spring_pendulum/io/particle_file.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr std::size_t kColumns = 3;
using Row = std::array<double, kColumns>;

class ParticleParser {
 public:
  explicit ParticleParser(std::string_view name) : name_(name) {}

  void parseLine(std::string_view line) {
    ++line_number_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    line = line.substr(0, line.find('#'));
    Row row{};
    std::size_t columns = 0;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line)) {
      if (columns < kColumns) row[columns] = parse(word);
      ++columns;
    }
    if (columns == 0) return;
    if (columns != kColumns) {
      refuse(counted(static_cast<std::int64_t>(columns), "number") +
             " in this line; a particle needs 3: x y m");
    }
    if (!rows_.empty()) checkMovingParticle(row);
    rows_.push_back(row);
    last_line_ = line_number_;
  }

  Particles particles() const {
    if (rows_.empty()) {
      throw InputError(fmt::format("{}: no particles; write one line 'x y m' per particle", name_));
    }
    const auto size = static_cast<Eigen::Index>(rows_.size());
    Particles result{AlignedNumbers(size), State(size)};
    for (Eigen::Index i = 0; i < size; ++i) {
      const Row& row = rows_[static_cast<std::size_t>(i)];
      result.state.x()[i] = row[0];
      result.state.y()[i] = row[1];
      result.masses[i] = row[2];
    }
    return result;
  }

 private:
  /// Removes and returns the first word of a line; empty at its end.
  static std::string_view nextWord(std::string_view& line) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    std::size_t begin = 0;
    while (begin < line.size() && is_blank(line[begin])) ++begin;
    std::size_t end = begin;
    while (end < line.size() && !is_blank(line[end])) ++end;
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
  }

  double parse(std::string_view word) const {
    const std::optional<double> value = parseNumber(word);
    if (!value) {
      const bool has_comma = word.find(',') != std::string_view::npos;
      refuse(fmt::format("{} is not a number; {}", inQuotes(word),
                         has_comma ? "use a decimal point, and spaces between numbers"
                                   : "write a finite number such as 0.5 or -2e-3"));
    }
    return *value + 0.0;  // turns -0.0 into 0.0
  }

  void checkMovingParticle(const Row& row) const {
    const double mass = row[2];
    if (!(mass > 0.0)) refuse(fmt::format("mass must be positive, got {} kg", numberText(mass)));
    if (!std::isfinite(1.0 / mass))
      refuse(fmt::format("mass must be large enough for 1/mass to be finite, got {} kg",
                         numberText(mass)));
    const double dx = row[0] - rows_.back()[0];
    const double dy = row[1] - rows_.back()[1];
    const double square = dx * dx + dy * dy;
    if (std::isnormal(square)) return;
    refuse(
        std::isfinite(square)
            ? fmt::format("same position as the particle in line {}; neighbours must not coincide",
                          last_line_)
            : fmt::format("too far from the particle in line {}; the square of their distance "
                          "must be finite",
                          last_line_));
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", name_, line_number_, what));
  }

  std::string_view name_;
  std::vector<Row> rows_;
  std::int64_t line_number_ = 0;
  std::int64_t last_line_ = 0;  ///< line of the last particle
};

}  // namespace

Particles parseParticles(std::string_view text, std::string_view name) {
  ParticleParser parser(name);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    parser.parseLine(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return parser.particles();
}

Particles readParticleFile(const std::string& path) {
  return parseParticles(readTextFile(path), path);
}

}  // namespace spring_pendulum

// The lines of a particle file.
#pragma once

#include <spring_pendulum/model/scene.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// Parses a particle file.
class ParticleParser {
 public:
  /// \param name of the text in error messages
  explicit ParticleParser(std::string_view name) : name_(name) {}

  /// Parses lines. The mass of the first particle is not checked.
  /// \throws InputError with file and line
  void parse(std::string_view lines);
  /// Parses one line without its newline.
  void parseLine(std::string_view line);

  /// Removes and returns the first line of a text, without its newline.
  static std::string_view nextLine(std::string_view& text);

  /// Returns the parsed particles, with velocity 0 if the file has none.
  /// \param keep_negative_zeros else, -0.0 becomes 0.0
  Scene particles(bool keep_negative_zeros = false) const;
  std::size_t size() const { return rows_.size(); }
  bool hasVelocities() const { return !velocities_.empty(); }

 private:
  static constexpr std::size_t kColumns = 3;
  static constexpr std::size_t kColumnsWithVelocity = 5;
  using Row = std::array<double, kColumns>;  ///< x, y, mass

  double parseWord(std::string_view word) const;
  void checkColumns(std::size_t columns) const;
  void checkMovingParticle(const Row& row) const;
  [[noreturn]] void refuse(const std::string& what) const;

  std::string_view name_;
  std::vector<Row> rows_;
  std::vector<std::array<double, 2>> velocities_;  ///< empty if the file has none
  std::int64_t line_number_ = 0;
  std::int64_t last_line_ = 0;  ///< line of the last particle
};

}  // namespace spring_pendulum

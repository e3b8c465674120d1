// The numbers in the text of frames, and how exactly they were printed.
#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include "check/motion.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace spring_pendulum {
namespace {

/// Returns a number, also nan and infinity as C and Python print them.
std::optional<double> valueOf(const std::string& word) {
  if (const std::optional<double> value = parseNumber(word)) return value;
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || std::isfinite(value)) return std::nullopt;
  return value;
}

/// How numbers are printed. A format limits either the decimals ("%.6f", round(x, 6)) or the significant
/// digits ("%g").
struct Format {
  int digits = 0, decimals = 0;

  void note(std::string_view word) {
    const std::string_view mantissa = word.substr(0, word.find_first_of("eE"));
    const std::size_t point = std::min(mantissa.find('.'), mantissa.size() - 1);
    auto after_point = static_cast<std::int64_t>(mantissa.size() - 1 - point);
    int count = 0;
    for (const char c : mantissa)
      if (('1' <= c && c <= '9') || (c == '0' && count > 0)) ++count;
    if (mantissa.size() < word.size())  // an exponent; beyond 400, the number is 0
      after_point -= std::clamp<std::int64_t>(
          parseInteger(word.substr(mantissa.size() + 1)).value_or(0), -400, 400);
    digits = std::max(digits, count);
    decimals = std::max(decimals, static_cast<int>(after_point));
  }

  /// One unit of the last digit: the larger of both units is right for each format.
  double unitOf(double value) const {
    const double unit = std::pow(10.0, -decimals);
    if (value == 0.0 || !std::isfinite(value)) return unit;
    return std::max(unit, std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits + 1.0));
  }
};

FrameNumbers read(const FrameText& frame, std::ptrdiff_t particles, Format& format) {
  std::vector<double> numbers;
  std::istringstream lines(frame.text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const auto refuse = [&](const std::string& what) {
      throw FileError(fmt::format("{}:{}: {}", frame.name, number, what));
    };
    for (char& c : line) c = c == ',' || c == ';' ? ' ' : c;
    std::istringstream words(line.substr(0, line.find('#')));
    std::int64_t columns = 0;
    for (std::string word; words >> word; ++columns) {
      const std::optional<double> value = valueOf(word);
      if (!value) refuse(inQuotes(word) + " is not a number");
      if (columns < 2) numbers.push_back(*value);
      if (std::isfinite(*value)) format.note(word);
    }
    if (columns != 0 && columns != 2)
      refuse(counted(columns, "number") +
             " in this line; a line of a frame is 'x y' with decimal points");
  }
  const auto rows = static_cast<std::ptrdiff_t>(numbers.size() / 2);
  if (rows != particles)
    throw FileError(fmt::format("{}: has {}, but the particle file has {}", frame.name,
                                counted(rows, "particle"), particles));
  using Rows = Eigen::Array<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
  return {frame.index, Eigen::Map<const Rows>(numbers.data(), rows, 2), {}};
}

/// Notes whether the numbers are floats: in all later frames or, with fewer than nine digits, in a rounded start.
void noteFloats(AllFrames& all, const Eigen::ArrayX2d& start) {
  constexpr double kRounded = 0.51, kLarge = 0x1p24;  // units; m, where Java prints more digits
  const auto is_float = [](double x, double unit) {
    const auto nearest = static_cast<float>(x);  // its text is that of Java, numpy and std::format
    return !(std::abs(x) < kLarge) || std::abs(x - nearest) <= kRounded * unit ||
           parseNumber(fmt::format("{}", nearest)) == x;
  };
  const auto floats = [&](const FrameNumbers& frame) {
    return frame.index == all.start || frame.positions.binaryExpr(frame.units, is_float).all();
  };
  const FrameNumbers& first = all.frames.front();
  const bool starts_so = all.digits < 9 && first.index == all.start &&
                         !first.equals(start, kRounded) && first.equalsFloatsOf(start, kRounded);
  if (!starts_so && !std::all_of(all.frames.begin(), all.frames.end(), floats)) return;
  double evidence = 0.0;  // log of how many numbers with as many digits there are for each float
  for (auto& [index, numbers, units] : all.frames) {
    const Eigen::ArrayX2d spacing = numbers.unaryExpr(
        [](double x) { return std::isfinite(x) ? std::exp2(std::logb(x) - 23.0) : 0.0; });
    const auto changed = numbers != start && numbers.abs() < kLarge;
    evidence += changed.select((spacing / units).max(1.0).log(), 0.0).sum();
    units = units.max(spacing);  // a double program may round what it prints
  }
  if (starts_so || evidence > 0.0) all.digits = std::min(all.digits, 7);
  all.are_floats |= starts_so || evidence > 12.0;
}

void noteMissingFrames(AllFrames& all, std::int64_t renumbered_by = 0) {
  std::int64_t last = all.start - 1, there = 0;  // in a row from the start
  for (const FrameNumbers& frame : all.frames) {
    if (frame.index == last) throw FileError(fmt::format("frame {} is there twice", last));
    if (frame.index - all.start == there) ++there;
    last = frame.index;
  }
  const auto count = last - all.start - static_cast<std::int64_t>(all.frames.size()) + 1;
  if (count == 0) return;
  all.notes.push_back(fmt::format("{}, the first is frame {}", counted(count, "missing frame"),
                                  all.start + there + renumbered_by));
}

}  // namespace

bool AllFrames::renumber(const Eigen::ArrayX2d& positions) {
  const FrameNumbers& first = frames.front();
  const std::int64_t shift = first.index - start;
  const bool is_start = first.equals(positions, 1.0) || first.equalsFloatsOf(positions, 1.0);
  if (shift == 0 || !is_start) return false;
  for (FrameNumbers& frame : frames) frame.index -= shift;
  noteFloats(*this, positions);
  notes.front() =  // instead of the missing frames
      fmt::format("the frames are numbered from {}; {} would be right", start + shift, start);
  noteMissingFrames(*this, shift);
  return true;
}

AllFrames readFrames(std::vector<FrameText> texts, const Scene& particles) {
  std::sort(texts.begin(), texts.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  Format format;
  AllFrames all;
  all.start = particles.frame;
  const Eigen::ArrayX2d start = particles.state.positions();
  for (const FrameText& text : texts) {
    if (text.index < all.start) continue;
    Format with_frame = format;
    all.frames.push_back(read(text, particles.state.size(), with_frame));
    // The start may be a copy of the particle file, with more digits than the other frames.
    const bool is_copy = all.frames.size() == 1 && (all.frames[0].positions == start).all();
    if (!is_copy || texts.size() == 1) format = with_frame;
  }
  if (all.frames.empty())
    throw FileError(fmt::format("no frames: neither {} nor later ones", frameName(all.start)));
  for (FrameNumbers& frame : all.frames)
    frame.units = frame.positions.unaryExpr([&](double value) { return format.unitOf(value); });
  all.digits = format.digits;
  noteFloats(all, start);
  noteMissingFrames(all);
  return all;
}

}  // namespace spring_pendulum

#include "check/frames.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

namespace spring_pendulum {
namespace {

/// Returns a number, also nan and infinity as C and Python print them.
std::optional<double> valueOf(std::string_view word) {
  if (const std::optional<double> value = parseNumber(word)) return value;
  const std::string text(word);
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || *end != '\0' || std::isfinite(value)) return std::nullopt;
  return value;
}

class FrameReader {
 public:
  /// Returns x and y of each line.
  FrameNumbers read(const FrameText& frame, std::ptrdiff_t particles) {
    std::vector<double> numbers;
    std::string_view text = frame.text;
    for (int number = 1; !text.empty(); ++number) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      const std::string_view line = text.substr(0, end);
      const std::string wrong = readLine(line.substr(0, line.find('#')), numbers);
      if (!wrong.empty()) throw FileError(fmt::format("{}:{}: {}", frame.name, number, wrong));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    const auto lines = static_cast<std::ptrdiff_t>(numbers.size() / 2);
    if (lines != particles) {
      throw FileError(fmt::format("{}: has {}, but the particle file has {}", frame.name,
                                  counted(lines, "particle"), particles));
    }
    using Rows = Eigen::Array<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
    return {frame.index, Eigen::Map<const Rows>(numbers.data(), lines, 2), {}};
  }

  int digits() const { return digits_; }

  /// One unit of the last digit. A format limits either the decimals ("%.6f", round(x, 6)) or the
  /// significant digits ("%g"): the larger of both units is right for each.
  double unitOf(double value) const {
    const double unit = std::pow(10.0, -decimals_);
    if (value == 0.0 || !std::isfinite(value)) return unit;
    return std::max(unit, std::pow(10.0, std::floor(std::log10(std::abs(value))) - digits_ + 1.0));
  }

 private:
  /// \returns what is wrong, or an empty text
  std::string readLine(std::string_view line, std::vector<double>& numbers) {
    constexpr std::string_view kSeparators = " \t\r,;";
    std::int64_t columns = 0;
    for (;; ++columns) {
      const std::size_t begin = std::min(line.find_first_not_of(kSeparators), line.size());
      line.remove_prefix(begin);
      if (line.empty()) break;
      const std::string_view word = line.substr(0, line.find_first_of(kSeparators));
      line.remove_prefix(word.size());
      const std::optional<double> value = valueOf(word);
      if (!value) return inQuotes(word) + " is not a number";
      if (columns < 2) numbers.push_back(*value);
      if (std::isfinite(*value)) noteFormat(word);
    }
    if (columns == 0 || columns == 2) return "";
    return counted(columns, "number") +
           " in this line; a line of a frame is 'x y' with decimal points";
  }

  void noteFormat(std::string_view word) {
    const std::size_t mantissa = std::min(word.find_first_of("eE"), word.size());
    int digits = 0;
    int decimals = 0;
    bool after_point = false;
    for (const char c : word.substr(0, mantissa)) {
      after_point |= c == '.';
      if (std::isdigit(static_cast<unsigned char>(c)) == 0) continue;
      if (digits > 0 || c != '0') ++digits;
      if (after_point) ++decimals;
    }
    constexpr std::int64_t kMostExponent = 400;  // of a number other than 0
    if (mantissa < word.size()) {
      decimals -= static_cast<int>(std::clamp(parseInteger(word.substr(mantissa + 1)).value_or(0),
                                              -kMostExponent, kMostExponent));
    }
    digits_ = std::max(digits_, digits);
    decimals_ = std::max(decimals_, decimals);
  }

  int digits_ = 0;
  int decimals_ = 0;
};

/// Whether a program in float wrote the frames: they begin with the start rounded to float, or have enough
/// digits to show that the last frame has only floats.
bool areFloats(const AllFrames& all, const Eigen::ArrayX2d& start) {
  constexpr int kDigitsOfFloat = 9;
  const auto rounded = [](const Eigen::ArrayX2d& numbers) -> Eigen::ArrayX2d {
    return numbers.cast<float>().cast<double>();
  };
  const Eigen::ArrayX2d& last = all.frames.back().positions;
  if (all.digits > kDigitsOfFloat && (last != start).any() && (last == rounded(last)).all())
    return true;
  const FrameNumbers& first = all.frames.front();
  constexpr double kRounded = 0.51;  // units of the last digit
  return first.index == all.start && !first.equals(start, kRounded) &&
         first.equals(rounded(start), kRounded);
}

/// \throws FileError for a large gap
std::string missingFrames(const AllFrames& all) {
  constexpr std::int64_t kMostMissing = 10'000;  // computing more takes minutes
  std::int64_t next = all.start;
  std::int64_t count = 0;
  std::string first;
  for (const FrameNumbers& frame : all.frames) {
    const std::int64_t gap = frame.index - std::exchange(next, frame.index + 1);
    if (gap < 0) throw FileError(fmt::format("frame {} is there twice", frame.index));
    if (gap > kMostMissing) {
      throw FileError(fmt::format("frame {}: {} frames before it are missing, at most {} may be",
                                  frame.index, gap, kMostMissing));
    }
    if (gap > 0 && count == 0) first = fmt::format(", the first is frame {}", frame.index - gap);
    count += gap;
  }
  return count == 0 ? "" : counted(count, "missing frame") + first;
}

}  // namespace

bool AllFrames::renumber(const Eigen::ArrayX2d& positions) {
  const std::int64_t shift = frames.front().index - start;
  if (shift == 0 || !frames.front().equals(positions, 1.0)) return false;
  for (FrameNumbers& frame : frames) frame.index -= shift;
  // Instead of the missing frames.
  remarks.front() =
      fmt::format("the frames are numbered from {}; {} would be right", start + shift, start);
  return true;
}

AllFrames readFrames(const std::vector<FrameText>& texts, const Particles& particles) {
  constexpr int kFewDigits = 5;
  FrameReader reader;
  AllFrames all;
  all.start = particles.frame;
  for (const FrameText& text : texts) {
    if (text.index < all.start) continue;
    all.frames.push_back(reader.read(text, particles.state.size()));
  }
  if (all.frames.empty())
    throw FileError("no frames; they are named frame_0000.txt, frame_0001.txt, ...");
  std::sort(all.frames.begin(), all.frames.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  for (FrameNumbers& frame : all.frames)
    frame.units = frame.positions.unaryExpr([&](double value) { return reader.unitOf(value); });
  all.digits = reader.digits();
  all.are_floats = areFloats(all, particles.state.positions());
  if (const std::string gaps = missingFrames(all); !gaps.empty()) all.remarks.push_back(gaps);
  if (all.digits <= kFewDigits) {
    all.remarks.push_back("few digits: " + counted(all.digits, "digit") +
                          " printed, too few to show small mistakes; print 17, for example with "
                          "std::setprecision(17)");
  }
  return all;
}

}  // namespace spring_pendulum

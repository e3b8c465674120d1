#include "check/frame_numbers.hpp"

#include "base/numbers.hpp"
#include "base/spelling.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>

namespace spring_pendulum {
namespace {

bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}

/// Returns nan or infinity as C and Python print them; nothing for other text.
std::optional<double> parseNotFinite(std::string_view word) {
  std::string name;
  for (const char c : word.substr(word.find_first_not_of("+-") == 1 ? 1 : 0)) {
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (name == "inf" || name == "infinity") return std::numeric_limits<double>::infinity();
  if (name.compare(0, 3, "nan") == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::nullopt;
}

class FrameReader {
 public:
  explicit FrameReader(std::ptrdiff_t particles) : particles_(particles) {}

  FrameNumbers read(const FrameText& frame) {
    name_ = frame.name;
    line_number_ = 0;
    numbers_.clear();
    std::string_view text = frame.text;
    while (!text.empty()) {
      const std::size_t end = text.find('\n');
      readLine(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    const auto lines = static_cast<std::ptrdiff_t>(numbers_.size() / 2);
    if (lines != particles_) {
      throw FileError(fmt::format("{}: has {}, but the particle file has {}", name_,
                                  counted(lines, "particle"), particles_));
    }
    using Rows = Eigen::Array<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
    return {frame.index, Eigen::Map<const Rows>(numbers_.data(), lines, 2), {}};
  }

  int digits() const { return digits_; }
  int decimals() const { return decimals_; }
  bool hasCommas() const { return has_commas_; }

 private:
  void readLine(std::string_view line) {
    ++line_number_;
    line = line.substr(0, line.find('#'));
    std::ptrdiff_t columns = 0;
    std::size_t begin = 0;
    for (;; ++columns) {
      while (begin < line.size() && isBlank(line[begin])) ++begin;
      if (columns > 0 && begin < line.size() && (line[begin] == ',' || line[begin] == ';')) {
        has_commas_ = true;
        for (++begin; begin < line.size() && isBlank(line[begin]);) ++begin;
      }
      if (begin >= line.size()) break;
      std::size_t end = begin;
      while (end < line.size() && !isBlank(line[end]) && line[end] != ',' && line[end] != ';')
        ++end;
      if (columns < 2) readNumber(line.substr(begin, end - begin));
      begin = end;
    }
    if (columns == 0 || columns == 2) return;
    refuse(counted(columns, "number") +
           (columns > 2 && has_commas_
                ? " in this line; write 'x y' with a decimal point and a blank between the numbers"
                : " in this line; a line of a frame is 'x y'"));
  }

  void readNumber(std::string_view word) {
    std::optional<double> value = parseNumber(word);
    if (value) {
      noteFormat(word);
    } else {
      value = parseNotFinite(word);
    }
    if (!value) refuse(inQuotes(word) + " is not a number");
    numbers_.push_back(*value);
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
    if (mantissa < word.size()) {
      constexpr std::int64_t kMostExponent = 400;  // of a number other than 0
      decimals -= static_cast<int>(std::clamp(parseInteger(word.substr(mantissa + 1)).value_or(0),
                                              -kMostExponent, kMostExponent));
    }
    digits_ = std::max(digits_, digits);
    decimals_ = std::max(decimals_, decimals);
  }

  [[noreturn]] void refuse(const std::string& what) const {
    throw FileError(fmt::format("{}:{}: {}", name_, line_number_, what));
  }

  std::ptrdiff_t particles_;
  std::string name_;
  std::int64_t line_number_ = 0;
  std::vector<double> numbers_;
  int digits_ = 0;
  int decimals_ = 0;
  bool has_commas_ = false;
};

/// A format either limits the decimals ("%.6f", round(x, 6)) or the significant digits ("%g"). The
/// larger of both units is right for each.
double unitOf(double value, const FrameReader& format) {
  const double decimal_unit = std::pow(10.0, -format.decimals());
  if (value == 0.0 || !std::isfinite(value)) return decimal_unit;
  return std::max(decimal_unit,
                  std::pow(10.0, std::floor(std::log10(std::abs(value))) - format.digits() + 1.0));
}

/// Whether a program in float wrote the frames: they begin with the start rounded to float, or have enough
/// digits to show that the last frame has only floats.
bool areFloats(const AllFrames& all, const Particles& particles) {
  constexpr int kDigitsOfFloat = 9;
  const auto rounded = [](const auto& numbers) {
    return numbers.template cast<float>().template cast<double>();
  };
  const FrameNumbers& last = all.frames.back();
  const Eigen::ArrayX2d start = particles.state.positions();
  if (all.digits > kDigitsOfFloat && (last.positions != start).any() &&
      (last.positions == rounded(last.positions)).all()) {
    return true;
  }
  const FrameNumbers& first = all.frames.front();
  const auto differs = [&](const Eigen::ArrayX2d& from) {
    return ((first.positions - from).abs() > 0.51 * first.units).any();
  };
  return first.index == all.start && differs(start) && !differs(rounded(start));
}

std::string fewDigits(int digits) {
  constexpr int kFew = 5;
  if (digits > kFew) return "";
  return fmt::format(
      "few digits: {} printed, too few to show small mistakes; print 17, for example "
      "with std::setprecision(17)",
      counted(digits, "digit"));
}

/// \throws FileError for a large gap
std::string missingFrames(const AllFrames& all) {
  constexpr std::int64_t kMostMissing = 10'000;  // computing more takes minutes
  std::int64_t next = all.start;
  std::int64_t count = 0;
  std::int64_t first = 0;
  for (const FrameNumbers& frame : all.frames) {
    const std::int64_t gap = frame.index - next;
    if (gap > kMostMissing) {
      throw FileError(fmt::format("frame {}: {} frames before it are missing, at most {} may be",
                                  frame.index, gap, kMostMissing));
    }
    if (count == 0) first = next;
    count += gap;
    next = frame.index + 1;
  }
  if (count == 0) return "";
  return fmt::format("{} missing, the first is frame {}",
                     counted(count, "frame") + (count == 1 ? " is" : " are"), first);
}

}  // namespace

AllFrames readFrames(const std::vector<FrameText>& texts, const Particles& particles) {
  FrameReader reader(particles.state.size());
  AllFrames all;
  all.start = particles.frame;
  for (const FrameText& text : texts) {
    if (text.index >= all.start) all.frames.push_back(reader.read(text));
  }
  if (all.frames.empty())
    throw FileError("no frames; they are named frame_0000.txt, frame_0001.txt, ...");
  std::sort(all.frames.begin(), all.frames.end(),
            [](const auto& a, const auto& b) { return a.index < b.index; });
  for (std::size_t i = 1; i < all.frames.size(); ++i) {
    if (all.frames[i].index == all.frames[i - 1].index)
      throw FileError(fmt::format("frame {} is there twice", all.frames[i].index));
  }
  for (FrameNumbers& frame : all.frames) {
    frame.units = frame.positions.unaryExpr([&](double value) { return unitOf(value, reader); });
  }
  all.digits = reader.digits();
  all.are_floats = areFloats(all, particles);
  for (const std::string& remark :
       {missingFrames(all), fewDigits(all.digits),
        std::string(reader.hasCommas()
                        ? "commas or semicolons separate the columns; the exercise wants blanks"
                        : "")}) {
    if (!remark.empty()) all.remarks.push_back(remark);
  }
  return all;
}

}  // namespace spring_pendulum

#include "mpi/part_file.hpp"

#include "io/files/paths.hpp"
#include "io/files/text_file.hpp"
#include "io/formats/particle_parser.hpp"
#include "io/formats/state_file.hpp"
#include "model/block_sums.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string>
#include <string_view>
#include <unistd.h>
#include <vector>

namespace spring_pendulum {
namespace {

constexpr std::int64_t kPiece = 1 << 16;

/// A text file that is read in parts.
class LargeTextFile {
 public:
  explicit LargeTextFile(const std::string& path) : path_(path), file_(openTextFile(path, size_)) {
    if (read(0, 3) == kByteOrderMark) begin_ = 3;
  }

  std::int64_t begin() const { return begin_; }
  std::int64_t size() const { return size_; }

  /// Returns bytes first <= i < last, fewer at the end of the file.
  std::string read(std::int64_t first, std::int64_t last) const {
    std::string text(static_cast<std::size_t>(std::max<std::int64_t>(0, last - first)), '\0');
    std::size_t length = 0;
    while (length < text.size()) {
      const ssize_t count = ::pread(file_.get(), text.data() + length, text.size() - length,
                                    first + static_cast<off_t>(length));
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) {
        throw FileError(
            fmt::format("{}: could not be read: {}", fullPath(path_), messageForErrno()));
      }
      if (count == 0) break;
      length += static_cast<std::size_t>(count);
    }
    text.resize(length);
    return text;
  }

  /// Returns the begin of the first line that begins at a place or behind it.
  std::int64_t lineFrom(std::int64_t place) const {
    if (place <= begin_) return begin_;
    for (std::int64_t at = place - 1; at < size_; at += kPiece) {
      const std::size_t found = read(at, at + kPiece).find('\n');
      if (found != std::string::npos) return at + static_cast<std::int64_t>(found) + 1;
    }
    return size_;
  }

 private:
  std::string path_;
  std::int64_t size_ = 0;
  std::int64_t begin_ = 0;
  FileDescriptor file_;
};

/// The lines of a text and the particles among them.
struct Lines {
  std::int64_t lines = 0;
  std::int64_t particles = 0;
};

/// Where a line is.
struct Place {
  std::int64_t begin = -1, end = -1, line = -1;
};

Lines countLines(std::string_view text) {
  Lines count;
  while (!text.empty()) {
    count.particles += ParticleParser::isParticle(ParticleParser::nextLine(text)) ? 1 : 0;
    ++count.lines;
  }
  return count;
}

/// Finds the lines of the wanted particles, which are sorted.
/// \param before what precedes the text, which begins at byte `begin`
void findPlaces(std::string_view text, std::int64_t begin, Lines before,
                const std::vector<std::int64_t>& wanted, std::vector<Place>& places) {
  auto next = std::lower_bound(wanted.begin(), wanted.end(), before.particles);
  const char* const start = text.data();
  while (!text.empty()) {
    const std::int64_t line_begin = begin + (text.data() - start);
    ++before.lines;
    if (!ParticleParser::isParticle(ParticleParser::nextLine(text))) continue;
    for (; next != wanted.end() && *next == before.particles; ++next) {
      places[static_cast<std::size_t>(next - wanted.begin())] = {
          line_begin, begin + (text.data() - start), before.lines};
    }
    ++before.particles;
  }
}

/// Returns the first spring of each rank, and the number of springs.
std::vector<std::int64_t> bordersOf(std::int64_t springs, std::int64_t ranks) {
  const std::int64_t block = sumBlockSize(springs);
  const std::int64_t blocks = (springs + block - 1) / block;
  std::vector<std::int64_t> borders;
  for (std::int64_t rank = 0; rank < ranks; ++rank)
    borders.push_back(blocks * rank / ranks * block);
  borders.push_back(springs);
  return borders;
}

/// The places of the border particles: each rank finds those in its share of the file.
std::vector<Place> placesOfBorders(const Ranks& ranks, const LargeTextFile& file, Part& part) {
  std::string text;
  std::int64_t begin = 0;
  Lines mine;
  ranks.together([&] {
    begin = file.lineFrom(file.size() * ranks.rank() / ranks.size());
    text = file.read(begin, file.lineFrom(file.size() * (ranks.rank() + 1) / ranks.size()));
    mine = countLines(text);
  });
  std::int64_t total_lines = 0;
  Lines before;
  before.lines = ranks.sumBefore(mine.lines, total_lines);
  before.particles = ranks.sumBefore(mine.particles, part.particles);
  const auto borders = bordersOf(std::max<std::int64_t>(0, part.particles - 1), ranks.size());
  part.first = borders[static_cast<std::size_t>(ranks.rank())];
  part.last = borders[static_cast<std::size_t>(ranks.rank()) + 1];
  std::vector<Place> places(borders.size());
  findPlaces(text, begin, before, borders, places);
  std::vector<std::int64_t> numbers;
  for (const Place& place : places) {
    numbers.insert(numbers.end(), {place.begin, place.end, place.line});
  }
  numbers = ranks.largest(std::move(numbers));
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  }
  return places;
}

void parsePart(const LargeTextFile& file, const Scenario& scenario, const Place& first,
               const Place& last, Part& part) {
  ParticleParser parser(scenario.particles, first.line);
  if (part.particles > 0) parser.parse(file.read(first.begin, last.end));
  part.own = parser.particles(scenario.resume);
  if (part.own.state.size() != part.last - part.first + 1) {
    throw FileError(fullPath(scenario.particles) + ": was changed while it was read");
  }
  if (!scenario.resume) {
    if (part.first == 0) part.own.state.velocities().row(0).setZero();  // P_1 is fixed
    return;
  }
  const StateHead head = parseStateHead(file.read(0, kPiece), scenario);
  checkStateEnd(head, part.particles, parser.hasVelocities(),
                file.read(file.size() - 1, file.size()) == "\n", scenario.particles);
  part.own.frame = head.frame;
}

}  // namespace

Part readPart(const Ranks& ranks, const Scenario& scenario) {
  std::optional<LargeTextFile> file;
  ranks.together([&] { file.emplace(scenario.particles); });
  Part part;
  const std::vector<Place> places = placesOfBorders(ranks, *file, part);
  const auto rank = static_cast<std::size_t>(ranks.rank());
  ranks.together([&] { parsePart(*file, scenario, places[rank], places[rank + 1], part); });
  return part;
}

}  // namespace spring_pendulum

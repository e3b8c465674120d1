#include <spring_pendulum/io/frame_writer.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <chrono>

namespace spring_pendulum {
namespace {

// The longest shortest text of a double is -2.2250738585072014e-308.
constexpr std::size_t kLongestNumber = 24;
constexpr std::size_t kLongestLine = 2 * (kLongestNumber + 1);

/// Adds the time it lives to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  using Clock = std::chrono::steady_clock;
  double& sum_;
  Clock::time_point start_ = Clock::now();
};

}  // namespace

FrameWriter::FrameWriter(const std::string& folder, std::int64_t frames)
    : folder_([&] {
        const Stopwatch stopwatch(seconds_);
        return FrameFolder(folder, frames);
      }()) {}

void FrameWriter::write(std::int64_t index, const State& state) {
  const Stopwatch stopwatch(seconds_);
  const auto size = static_cast<std::size_t>(state.size());
  if (text_.size() < size * kLongestLine) text_.resize(size * kLongestLine);
  char* end = text_.data();
  for (Eigen::Index i = 0; i < state.size(); ++i) {
    end = fmt::format_to(end, FMT_COMPILE("{} {}\n"), state.x()[i], state.y()[i]);
  }
  folder_.writeFrame(index, text_.data(), static_cast<std::size_t>(end - text_.data()));
}

void FrameWriter::finish() {
  const Stopwatch stopwatch(seconds_);
  folder_.close();
}

}  // namespace spring_pendulum

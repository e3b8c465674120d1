#include "result_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <unistd.h>

#include "peer.hpp"

namespace spring_pendulum::benchmark {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string load() {
  std::array<double, 1> average{};
  return getloadavg(average.data(), 1) == 1 ? fmt::format("{:.2f}", average[0]) : "unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
  return text.data();
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "unknown" : value;
}

}  // namespace

ResultFile::ResultFile(const std::string& path, const std::vector<std::string>& title,
                       const std::string& columns)
    : file_(path) {
  if (!file_) throw std::runtime_error(path + ": cannot be written");
  for (const std::string& line : title) file_ << "# " << line << '\n';
  file_ << fmt::format("# machine: {}, {} processors\n", processor(),
                       sysconf(_SC_NPROCESSORS_ONLN));
  file_ << "# load when started (other work on the machine counts): " << load() << '\n';
  file_ << "# compiler: " << BENCHMARK_COMPILER << '\n';
  file_ << "# flags of the package: " << BENCHMARK_FLAGS << '\n';
  file_ << "# more flags of the baselines and of all that the peers compile here: "
        << BENCHMARK_VECTOR_FLAGS << '\n';
  file_ << "# commit: " << environment("SPRING_PENDULUM_COMMIT") << '\n';
  file_ << "# date: " << today() << '\n';
  for (const std::string& library : missingPeers()) {
    file_ << "# not built, so not measured: " << library << '\n';
  }
  file_ << columns << std::endl;
}

void ResultFile::add(const std::string& row) {
  file_ << row << std::endl;
}

std::string quoted(const std::string& text) {
  std::string line = text;
  std::replace(line.begin(), line.end(), '\n', ' ');
  std::replace(line.begin(), line.end(), '"', '\'');
  return '"' + line + '"';
}

}  // namespace spring_pendulum::benchmark

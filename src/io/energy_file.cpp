#include "io/energy_file.hpp"

#include <spring_pendulum/model/errors.hpp>

#include <fmt/compile.h>
#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <iterator>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>

namespace spring_pendulum {
namespace {

constexpr std::size_t kBufferSize = 1 << 16;
constexpr const char* kHeader =
    "frame,time [s],kinetic [J],gravity [J],spring [J],total [J],dissipated [J],residual [J],"
    "residual/scale [1],position error [m]\n";

}  // namespace

EnergyFile::EnergyFile(const std::string& path)
    : path_(path), unfinished_path_(path + ".unfinished"), text_(kHeader) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    throw FileError(fmt::format("{}: is a folder or a device, must be a regular file", path));
  }
  FileDescriptor file(::open(unfinished_path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666));
  if (!file.isOpen()) refuse();
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw FileError(fmt::format("{}: another run writes it, must be a file of its own", path));
  }
  if (::ftruncate(file.get(), 0) != 0) refuse();
  file_ = std::move(file);
}

EnergyFile::~EnergyFile() {
  if (file_.isOpen()) ::unlink(unfinished_path_.c_str());
}

void EnergyFile::write(std::int64_t frame, const EnergyEntry& entry, double position_error) {
  fmt::format_to(std::back_inserter(text_), FMT_COMPILE("{},{},{},{},{},{},{},{},{},{}\n"), frame,
                 entry.time, entry.energy.kinetic, entry.energy.gravity, entry.energy.spring,
                 entry.energy.total(), entry.dissipated.value(), entry.residual.value(),
                 entry.relative_residual.value(), position_error);
  if (text_.size() > kBufferSize) flush();
}

void EnergyFile::finish() {
  flush();
  if (::rename(unfinished_path_.c_str(), path_.c_str()) != 0) refuse();
  if (!file_.close()) refuse();
}

void EnergyFile::flush() {
  const char* data = text_.data();
  std::size_t size = text_.size();
  while (size > 0) {
    const ssize_t count = ::write(file_.get(), data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse();
    data += count;
    size -= static_cast<std::size_t>(count);
  }
  text_.clear();
}

void EnergyFile::refuse() const {
  throw FileError(
      fmt::format("{}: could not be written: {}", path_, std::generic_category().message(errno)));
}

}  // namespace spring_pendulum

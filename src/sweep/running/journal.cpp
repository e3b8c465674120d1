#include "sweep/running/journal.hpp"

#include "base/numbers.hpp"
#include "io/files/paths.hpp"
#include "io/files/text_file.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>

namespace spring_pendulum::sweep {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExtension = ".journal";
constexpr int kMostJournals = 1'000'000;

[[noreturn]] void refuse(const std::string& path) {
  throw FileError(fmt::format("{}: could not be written: {}", fullPath(path), messageForErrno()));
}

}  // namespace

Journals::Journals(std::string folder, std::uint64_t hash)
    : folder_(std::move(folder)),
      head_(fmt::format("spring_pendulum " SPRING_PENDULUM_VERSION " sweep {:016x}\n", hash)) {}

void Journals::start() {
  std::error_code ignored;  // open() reports the folder that is missing
  fs::create_directories(folder_, ignored);
  for (int number = 1; number <= kMostJournals; ++number) {
    path_ = fmt::format("{}/{}{}", folder_, number, kExtension);
    file_ = FileDescriptor(
        ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666));
    if (file_.isOpen()) return write(head_);
    if (errno != EEXIST) refuse(path_);
  }
  throw FileError(fmt::format("{}: has too many journals", fullPath(folder_)));
}

void Journals::read(const std::function<void(std::int64_t index, std::string_view text)>& take) {
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry->path().extension() != kExtension) continue;
    try {
      readFile(entry->path().string(), take);
    } catch (const FileError&) {
      if (fs::exists(entry->path())) throw;  // else another process has just written the table
    }
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw FileError(fmt::format("{}: could not be read: {}", fullPath(folder_), error.message()));
  }
}

void Journals::readFile(const std::string& path,
                        const std::function<void(std::int64_t, std::string_view)>& take) {
  const std::string file = readTextFile(path);
  const std::string_view text(file);
  if (text.substr(0, head_.size()) != std::string_view(head_).substr(0, text.size())) {
    ::unlink(path_.c_str());
    throw InputError(
        fmt::format("{}: is the journal of another study or version; remove {} to "
                    "start anew, or give another --output",
                    fullPath(path), fullPath(folder_)));
  }
  std::size_t begin = head_.size();
  for (std::size_t end = 0; begin < text.size(); begin = end + 1) {
    end = text.find('\n', begin);
    if (end == std::string_view::npos) return;  // torn
    const std::string_view line = text.substr(begin, end - begin);
    const std::size_t comma = std::min(line.find(','), line.size());
    const std::optional<std::int64_t> index = parseInteger(line.substr(0, comma));
    if (index) take(*index, line.substr(comma));
  }
}

void Journals::append(std::int64_t index, std::string_view text) {
  write(fmt::format("{}{}\n", index, text));
}

void Journals::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file_.get(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path_);
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

bool Journals::lock() {
  // A lock on NFS needs a file that is open for writing.
  const std::string path = folder_ + "/lock";
  lock_ = FileDescriptor(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  while (lock_.isOpen() && ::flock(lock_.get(), LOCK_EX) != 0 && errno == EINTR) {
  }
  return ::access(path_.c_str(), F_OK) == 0;
}

void Journals::remove() {
  file_.close();
  std::error_code ignored;  // a journal that stays is read again and changes nothing
  for (fs::directory_iterator entry(folder_, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    if (entry->path().extension() != kExtension) continue;
    std::string head;
    std::getline(std::ifstream(entry->path()), head);
    std::error_code kept;
    if (head + '\n' == head_) fs::remove(entry->path(), kept);  // another study may have begun
  }
  fs::remove(folder_ + "/lock", ignored);
  fs::remove(folder_, ignored);
}

}  // namespace spring_pendulum::sweep

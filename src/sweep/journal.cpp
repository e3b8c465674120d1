#include "sweep/journal.hpp"

#include "base/numbers.hpp"
#include "io/files/posix.hpp"
#include "sweep/study/study.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <sstream>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace spring_pendulum::sweep {
namespace {

[[noreturn]] void refuse(const std::string& path) {
  throw FileError(fmt::format("{}: could not be written: {}", fullPath(path), messageForErrno()));
}

}  // namespace

Journal::Journal(std::string path, std::uint64_t hash, const std::string& table)
    : path_(std::move(path)),
      hash_(hash),
      head_(fmt::format("spring_pendulum " SPRING_PENDULUM_VERSION " sweep {:016x}\n", hash)) {
  do {
    // A lock on NFS needs a file that is open for writing.
    file_ = FileDescriptor(
        ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NONBLOCK | O_CLOEXEC, 0666));
    if (!file_.isOpen()) refuse(path_);
  } while (!lock());
  const std::string begin = readTextFile(path_).substr(0, head_.size());
  if (begin.empty() && !table.empty() && std::filesystem::exists(table)) {
    ::unlink(path_.c_str());
    throw InputError(table + ": exists; remove it to run its shards anew");
  }
  if (head_.compare(0, begin.size(), begin) != 0)
    throw InputError(fmt::format(
        "{}: is the journal of another study or version; remove it, or give another --output",
        fullPath(path_)));
  cutTornLine();
  if (begin.size() < head_.size()) write(head_);
  ::flock(file_.get(), LOCK_UN);
}

void Journal::read(
    const std::function<void(std::int64_t index, std::string_view text)>& take) const {
  std::istringstream lines(readTextFile(path_));
  std::string line;
  // A line that ends with the file is unfinished.
  for (int number = 1; std::getline(lines, line) && !lines.eof(); ++number) {
    if (line + '\n' == head_) continue;  // without locks, two processes may begin at once
    const std::string row = line.substr(0, line.rfind(' '));
    if (line + '\n' != lineOf(row))
      throw InputError(fmt::format("{}:{}: is damaged; remove the line to run its case anew",
                                   fullPath(path_), number));
    const std::size_t comma = row.find(',');
    take(parseInteger(row.substr(0, comma)).value(), row.substr(comma));
  }
}

bool Journal::append(std::int64_t index, std::string_view text) {
  const bool is_there = lock();
  cutTornLine();
  write(lineOf(fmt::format("{}{}", index, text)));
  ::flock(file_.get(), LOCK_UN);
  return is_there;
}

std::string Journal::lineOf(std::string_view row) const {
  return fmt::format("{} {:016x}\n", row, hashOf(row, hash_));
}

bool Journal::lock() {
  // Where a file system has no locks, appending one line is still one call.
  while (::flock(file_.get(), LOCK_EX) != 0 && errno == EINTR) continue;
  struct stat named = {}, opened = {};
  return ::stat(path_.c_str(), &named) == 0 && ::fstat(file_.get(), &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

void Journal::cutTornLine() {
  off_t size = 0, end = 0, last_end = 0;
  do {  // until the end stays: without locks, another process may be writing the line
    last_end = end;
    size = end = ::lseek(file_.get(), 0, SEEK_END);
    for (char last = 0; size > 0; --size)
      if (::pread(file_.get(), &last, 1, size - 1) != 1 || last == '\n') break;
    if (size == end) return;
    if (end != last_end) ::usleep(20000);
  } while (end != last_end);
  if (::ftruncate(file_.get(), size) != 0) refuse(path_);
}

void Journal::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file_.get(), text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path_);
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

}  // namespace spring_pendulum::sweep

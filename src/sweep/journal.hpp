// The finished cases of a sweep, on disk as soon as they are finished.
//
// All processes that work on a table append to one file beside it, each time under the lock of the file.
// The first line names the study and the version; each other line is a case and ends with a hash of the
// study and the line. A kill can only tear the last line, which is cut off before anything is appended.
#pragma once

#include "io/files/posix.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace spring_pendulum::sweep {

class Journal {
 public:
  /// Opens the file, or creates it.
  /// \param hash  of the study
  /// \param table whose shards it is of; "": no shards
  /// \throws FileError, InputError for a journal of another study or if only the table is there
  Journal(std::string path, std::uint64_t hash, const std::string& table);

  /// Passes all finished cases to `take`, in any order.
  /// \throws FileError, and InputError for a damaged line
  void read(const std::function<void(std::int64_t index, std::string_view text)>& take) const;
  /// Appends a case. Returns false as `lock`. \throws FileError
  bool append(std::int64_t index, std::string_view text);

  /// Keeps other processes from this file until the next `append` or the end.
  /// \returns false if the file was removed or replaced meanwhile, as when another process has written the table
  bool lock();

  const std::string& path() const { return path_; }

 private:
  std::string lineOf(std::string_view row) const;
  void cutTornLine();
  void write(std::string_view text);

  std::string path_;
  std::uint64_t hash_;
  std::string head_;
  FileDescriptor file_;
};

}  // namespace spring_pendulum::sweep

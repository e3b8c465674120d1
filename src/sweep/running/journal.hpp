// Journals: the finished cases of a sweep, on disk as soon as they are finished.
//
// A folder beside the table holds a file for each process that ever worked on it. A file starts with a
// line that names the study and the version. Each other line is a case. It is appended by one call, so
// a kill can only tear the last line, which is dropped.
#pragma once

#include "io/files/file_descriptor.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace spring_pendulum::sweep {

class Journals {
 public:
  /// \param folder created by `start`
  /// \param hash   of the study
  Journals(std::string folder, std::uint64_t hash);

  /// Creates the folder and the journal of this process.
  /// \throws FileError
  void start();
  /// Passes all finished cases to `take`, in any order.
  /// \throws InputError naming a journal of another study or version; the own journal is removed then
  /// \throws FileError naming a file that can't be read
  void read(const std::function<void(std::int64_t index, std::string_view text)>& take);
  /// Appends a case. \throws FileError
  void append(std::int64_t index, std::string_view text);

  /// Waits until no other process holds the lock of the folder, and holds it until the end.
  /// \returns false if another process has removed the journal of this one meanwhile, because it has
  ///   written the table
  bool lock();
  /// Removes all journals and the folder.
  void remove();

  const std::string& folder() const { return folder_; }

 private:
  void readFile(const std::string& path,
                const std::function<void(std::int64_t, std::string_view)>& take);
  void write(std::string_view text);

  std::string folder_;
  std::string head_;
  std::string path_;
  FileDescriptor file_;
  FileDescriptor lock_;
};

}  // namespace spring_pendulum::sweep

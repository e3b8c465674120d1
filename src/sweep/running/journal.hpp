// Journals: the finished cases of a sweep, on disk as soon as they are finished.
//
// A folder beside the table holds a file for each process that ever worked on it. A file starts with a
// line that names the study and the version. Then each line holds a case and ends with a checksum, so a
// line that a kill has torn is recognised and dropped.
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

  /// Passes all finished cases to `take`, in any order. Does not need the folder to exist.
  /// \throws InputError naming a journal of another study or version
  /// \throws FileError naming a file that can't be read
  void read(const std::function<void(std::int64_t index, std::string_view text)>& take) const;

  /// Creates the folder and the journal of this process.
  /// \throws FileError
  void start();
  /// Adds a case to `lines`, the argument of `write`.
  void addLine(std::int64_t index, std::string_view text, std::string& lines) const;
  /// Appends lines. \throws FileError
  void write(std::string_view lines);

  /// Waits until no other process holds the lock of the folder, and holds it until the end.
  /// \returns false if another process has removed the journal of this one meanwhile, because it has
  ///   written the table
  bool lock();
  /// Removes all journals and the folder.
  void remove();

  const std::string& folder() const { return folder_; }

 private:
  void readFile(const std::string& path,
                const std::function<void(std::int64_t, std::string_view)>& take) const;

  std::string folder_;
  std::uint64_t hash_;
  std::string head_;
  std::string path_;
  FileDescriptor file_;
  FileDescriptor lock_;
};

}  // namespace spring_pendulum::sweep

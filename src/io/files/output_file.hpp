// An output file of a run: the energy balance, a bag.
#pragma once

#include "io/files/unfinished_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// Writes FILE.unfinished and renames it to FILE at the end. So FILE is complete or absent, and a
/// FILE of an earlier run is replaced only at the end. If FILE is a symbolic link, its target is
/// replaced and the link stays. A lock on FILE.unfinished ensures that only one run writes it.
class OutputFile {
 public:
  /// \param path checked with `checkTouchedFiles`
  /// \throws InputError if the path is that of a frame file
  /// \throws FileError if it is a folder, a pipe or a device, if it can't be written, or if another
  ///         run is writing it
  explicit OutputFile(const std::string& path);
  /// Removes the file if it is not finished.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// \throws FileError naming the file
  void write(std::string_view text);
  /// Copies an earlier FILE to the beginning of the new one.
  /// \returns whether there is an earlier FILE
  /// \throws FileError naming the file
  bool copyEarlier();
  /// Returns a path by which a library can open the unfinished file.
  std::string unfinishedPath() const;
  /// Returns the size of the unfinished file, bytes.
  std::uintmax_t size() const;
  /// Closes the file and gives it its final name.
  /// \throws FileError naming the file
  void finish();

  /// Absolute path.
  const std::string& path() const { return path_; }

 private:
  void openFolder();
  void createUnfinished();
  void keepPermissions();
  bool lock();
  void refuseUnlessUnfinished() const;
  [[noreturn]] void refuse(const std::string& reason) const;
  [[noreturn]] void refuseForErrno() const;

  std::string path_;         ///< absolute
  std::string folder_path_;  ///< path of the folder as given, for `leadsTo`
  std::string name_;
  FileDescriptor folder_;
  UnfinishedFile file_;
};

}  // namespace spring_pendulum

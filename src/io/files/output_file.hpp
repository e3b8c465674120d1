// An output file of a run: the energy balance, a bag.
#pragma once

#include "io/files/atomic_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// A file that is complete or absent. A file of an earlier run is replaced only at the end, and keeps its
/// permissions. If the path is a symbolic link, its target is replaced and the link stays.
class OutputFile {
 public:
  /// \param path checked with `checkTouchedFiles`
  /// \throws InputError if the path is that of a frame file
  /// \throws FileError if it is a folder, a pipe or a device, if it can't be written, or if another
  ///         run is writing it
  explicit OutputFile(const std::string& path);

  /// \throws FileError naming the file
  void write(std::string_view text) { file_.write(text); }
  /// Copies an earlier file to the beginning of the new one.
  /// \returns whether there is an earlier file
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
  std::string path_;
  std::string target_;  ///< behind symbolic links
  OutputFolder folder_;
  AtomicFile file_;
};

}  // namespace spring_pendulum

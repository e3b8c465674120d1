// A file that a run writes: the energy balance, a bag.
#pragma once

#include "io/unfinished_file.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace spring_pendulum {

/// Written as FILE.unfinished and renamed at the end, so FILE is whole or absent, and a FILE of an
/// earlier run is replaced only then. If FILE is a symbolic link, the file it leads to is written
/// and the link stays. FILE.unfinished is locked: one run at a time writes a file.
class OutputFile {
 public:
  /// \param inputs files that the run reads, which must not be written
  /// \throws InputError if the path is that of an input or of a frame file
  /// \throws FileError if it is a folder, a pipe or a device, if it can't be written, or if another
  ///         run is writing it
  explicit OutputFile(const std::string& path, const std::vector<std::string>& inputs = {});
  /// What is not finished is removed.
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// \throws FileError naming the file
  void write(std::string_view text);
  /// Begins with the bytes of the file that is going to be replaced, if there is one.
  /// \returns whether there is
  /// \throws FileError naming the file
  bool copyEarlier();
  /// A path by which a library can open the unfinished file once more.
  std::string unfinishedPath() const;
  /// Bytes written so far, by whomever.
  std::uintmax_t size() const;
  /// \throws FileError naming the file
  void finish();

  /// The whole path.
  const std::string& path() const { return path_; }

 private:
  void openFolder();
  void createUnfinished();
  bool lock();
  void refuseUnlessUnfinished() const;
  [[noreturn]] void refuse(const std::string& reason) const;
  [[noreturn]] void refuseForErrno() const;

  std::string path_;         ///< as it is shown
  std::string folder_path_;  ///< of the file, as it was given
  std::string name_;
  FileDescriptor folder_;
  UnfinishedFile file_;
};

}  // namespace spring_pendulum

// Output files that are complete or absent: each is written under a hidden name and renamed at the end.
#pragma once

#include "io/files/posix.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace spring_pendulum {

/// An open folder for output files. They stay together if the folder is moved.
class OutputFolder {
 public:
  /// Creates the folder if needed.
  /// \throws FileError naming the folder
  explicit OutputFolder(const std::string& path);

  int descriptor() const { return descriptor_.get(); }
  /// Absolute path.
  const std::string& path() const { return path_; }
  /// \throws FileError if the path no longer leads to this folder
  void checkPath() const;

 private:
  std::string given_path_;
  std::string path_;
  FileDescriptor descriptor_;
};

/// ".NAME.tmp"
std::string hiddenName(const std::string& name);

/// Writes a file under its hidden name and renames it at the end, replacing any file of that name.
class AtomicFile {
 public:
  enum class Lock { kNone, kOneWriter };

  /// Opens the hidden file. With a lock, what a killed run left is overwritten, and a second writer is
  /// refused. Without, the caller has removed what was left, and ensures that there is one writer.
  /// \param folder must outlive this object
  /// \param path   for messages
  /// \throws FileError naming the path
  AtomicFile(const OutputFolder& folder, std::string name, std::string path, Lock lock);
  ~AtomicFile() { discard(); }
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  int descriptor() const { return file_.get(); }
  const std::string& path() const { return path_; }
  /// \throws FileError naming the path
  void write(std::string_view text);
  void finish();
  /// Removes the file if it is not finished.
  void discard();
  [[noreturn]] void refuse(const std::string& reason) const;
  [[noreturn]] void refuseForErrno() const;

 private:
  void open(int flags);
  /// \returns false if the run that held the lock has renamed or removed the file meanwhile
  bool takeLock();
  [[noreturn]] void refuseTaken() const;

  const OutputFolder& folder_;
  std::string name_;
  std::string hidden_;
  std::string path_;
  FileDescriptor file_;
};

/// An output file of a run, as a user names it: the energy balance, a bag. A file of an earlier run is
/// replaced only at the end, and keeps its permissions. Of a symbolic link, the target is replaced.
class OutputFile {
 public:
  /// \param path checked with `checkTouchedFiles`
  /// \throws InputError if the path is that of a frame file
  /// \throws FileError if it is no regular file, can't be written, or another run is writing it
  explicit OutputFile(const std::string& path);

  /// Appends text, buffered.
  /// \throws FileError naming the file
  void write(std::string_view text);
  /// Copies an earlier file to the beginning of the new one.
  /// \returns whether there is an earlier file
  /// \throws FileError naming the file
  bool copyEarlier();
  /// Returns the first bytes of an earlier file; empty: there is none. Throws as `readTextFile`.
  std::string earlierText(std::size_t most = std::string::npos) const;
  /// Returns a path by which another program or library can open the unfinished file.
  std::string unfinishedPath();
  /// Returns the size of the unfinished file, bytes.
  std::uintmax_t size() const;
  /// Closes the file and gives it its final name.
  /// \throws FileError naming the file
  void finish();

  /// Absolute path.
  const std::string& path() const { return file_.path(); }

 private:
  void flush();

  std::string target_;  ///< behind symbolic links
  OutputFolder folder_;
  AtomicFile file_;
  std::string text_;  ///< not written yet
};

}  // namespace spring_pendulum

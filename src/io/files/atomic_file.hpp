// Files that are complete or absent: each is written under a hidden name and renamed at the end.
#pragma once

#include "io/files/file_descriptor.hpp"

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
  /// `kEmpty`: for one writer, which never writes, so that a file with content is somebody else's.
  enum class Lock { kNone, kOneWriter, kEmpty };

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
  bool takeLock(Lock lock);
  [[noreturn]] void refuseTaken() const;

  const OutputFolder& folder_;
  std::string name_;
  std::string hidden_;
  std::string path_;
  FileDescriptor file_;
};

}  // namespace spring_pendulum

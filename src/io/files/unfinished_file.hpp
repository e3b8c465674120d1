// A file that is written under a temporary name and renamed when it is complete.
#pragma once

#include "io/files/file_descriptor.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <sys/stat.h>
#include <utility>

namespace spring_pendulum {

/// All output files are written through this class. Its functions return false with errno set on
/// failure; the caller makes the message.
class UnfinishedFile {
 public:
  UnfinishedFile() = default;
  /// \param folder open folder, which must outlive this object
  /// \param name   temporary name in the folder
  UnfinishedFile(int folder, std::string name) : folder_(folder), name_(std::move(name)) {}

  /// Creates the file. Fails if the name exists, also as a link or a pipe.
  bool create();
  /// Opens an existing file for writing. Does not follow links and does not block.
  bool open();
  /// Opens a file of an earlier run, to overwrite it from the beginning, if it has only one name
  /// and the owner, group and permissions of a new file.
  /// \param fresh status of a new file in this folder
  bool reuse(const struct stat& fresh);

  bool isOpen() const { return file_.isOpen(); }
  int descriptor() const { return file_.get(); }
  const std::string& name() const { return name_; }
  /// Whether the temporary name still leads to this file.
  bool hasItsName() const;

  bool write(const char* data, std::size_t size);
  /// Tells the length of a file to which other processes have written, too.
  void setLength(std::int64_t length) { length_ = length; }
  /// Truncates the file after the last byte written and renames it, replacing any file of that
  /// name.
  bool appearAs(const std::string& name);
  /// Closes and removes the file.
  void remove();

 private:
  int folder_ = -1;
  std::string name_;
  FileDescriptor file_;
  bool reused_ = false;
  std::int64_t length_ = 0;  ///< bytes written so far
};

}  // namespace spring_pendulum

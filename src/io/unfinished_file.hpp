// A file that is written under another name and gets its own when it is whole.
#pragma once

#include "io/file_descriptor.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <sys/stat.h>
#include <utility>

namespace spring_pendulum {

/// Every output file is written through this class. Its functions return false with errno set if
/// they fail; who owns the file knows what to call it in a message.
class UnfinishedFile {
 public:
  UnfinishedFile() = default;
  /// \param folder open folder, which outlives this
  /// \param name   inside the folder, until the file is whole
  UnfinishedFile(int folder, std::string name) : folder_(folder), name_(std::move(name)) {}

  /// Creates the file. Fails if there is anything of this name, be it a link or a pipe.
  bool create();
  /// Opens a file that is there for writing. Never follows a link and never waits.
  bool open();
  /// Opens a file of an earlier run, to be written from the beginning, if it has one name only and
  /// the owner, group and permissions of a new file.
  /// \param fresh what a new file in this folder is like
  bool reuse(const struct stat& fresh);

  bool isOpen() const { return file_.isOpen(); }
  int descriptor() const { return file_.get(); }
  const std::string& name() const { return name_; }
  /// Whether the name in the folder still leads to this file.
  bool hasItsName() const;

  bool write(const char* data, std::size_t size);
  /// Brings the file to its end and gives it its own name, in place of any file that has it.
  bool appearAs(const std::string& name);
  /// Closes and removes it.
  void remove();

 private:
  int folder_ = -1;
  std::string name_;
  FileDescriptor file_;
  bool reused_ = false;
  std::int64_t length_ = 0;  ///< written so far, bytes
};

}  // namespace spring_pendulum

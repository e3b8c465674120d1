#include "io/files/touched_files.hpp"

#include "io/files/frame_folder.hpp"
#include "io/files/paths.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <sys/stat.h>
#include <unistd.h>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // the limit of Linux

constexpr const char* kStreamNames[] = {"standard input", "standard output", "standard error"};

enum class Use { kInput, kStandardInput, kStandardOutput, kOutput, kFrames };

/// A file or folder, which need not exist.
struct Touched {
  Use use;
  std::string shown;  ///< for messages
  fs::path path;      ///< without links

  bool isStream() const { return use == Use::kStandardInput || use == Use::kStandardOutput; }
};

/// Whether two paths lead to the same file, also by a hard link or a second mount.
bool areSame(const fs::path& a, const fs::path& b) {
  struct stat status_a {
  }, status_b{};
  return a == b || (::lstat(a.c_str(), &status_a) == 0 && ::lstat(b.c_str(), &status_b) == 0 &&
                    isSameFile(status_a, status_b));
}

bool areSame(const Touched& a, const Touched& b) {
  return areSame(a.path, b.path) || (a.path.filename() == b.path.filename() &&
                                     areSame(a.path.parent_path(), b.path.parent_path()));
}

/// Whether writing `a` would change or remove `b`.
bool affects(const Touched& a, const Touched& b) {
  switch (a.use) {
    case Use::kInput:
    case Use::kStandardInput:
      return false;
    case Use::kStandardOutput:
      return b.use == Use::kInput && areSame(a, b);
    case Use::kFrames:
      return (b.use == Use::kOutput && areSame(a, b)) ||
             (isFrameName(b.path.filename().string()) && areSame(a.path, b.path.parent_path()));
    case Use::kOutput:
      break;
  }
  const std::string folder = a.path.string() + '/';
  return areSame(a, b) || b.path.string().compare(0, folder.size(), folder) == 0;
}

[[noreturn]] void refuse(const Touched& a, const Touched& b) {
  const bool is_frame = a.use == Use::kFrames && isFrameName(b.path.filename().string());
  const std::string& file = is_frame ? b.shown : a.shown;
  const char* const cure = is_frame ? "another folder for the frames" : "another file";
  if (a.use == Use::kOutput && (b.use == Use::kInput || b.isStream()) && !areSame(a, b)) {
    throw FileError(fmt::format("{}: is a folder with {} in it; give a file", file, b.shown));
  }
  if (b.isStream()) {
    throw FileError(fmt::format("{}: is a standard stream of this program; give {}", file, cure));
  }
  if (b.use == Use::kInput) {
    throw InputError(
        fmt::format("{}: is an input of this run and would be overwritten; choose {}", file, cure));
  }
  if (is_frame) {
    throw InputError(file + ": is the name of a frame file; give another name");
  }
  if (file == b.shown) {
    throw InputError(file + ": is given for two outputs; choose another file");
  }
  throw InputError(fmt::format("{}: is needed for {} too; choose another file", file, b.shown));
}

std::vector<Touched> listTouched(const TouchedFiles& files) {
  std::vector<Touched> touched;
  const auto add = [&touched](Use use, const std::string& path, const std::string& shown) {
    if (path.empty()) return;
    std::error_code ignored;  // whoever opens the file reports it
    const fs::path target = fs::absolute(followLinks(path), ignored);
    fs::path canonical = fs::weakly_canonical(target, ignored).lexically_normal();
    if (!canonical.has_filename()) canonical = canonical.parent_path();
    touched.push_back({use, shown, canonical.empty() ? target : canonical});
  };
  for (const std::string& input : files.inputs) add(Use::kInput, input, fullPath(input));
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    struct stat status {};
    if (::fstat(stream, &status) != 0 || !S_ISREG(status.st_mode)) continue;
    add(stream == STDIN_FILENO ? Use::kStandardInput : Use::kStandardOutput,
        fmt::format("/proc/self/fd/{}", stream), kStreamNames[stream]);
  }
  for (const std::string& output : files.outputs) {
    add(Use::kOutput, output, fullPath(output));
    if (output.empty()) continue;
    Touched unfinished = touched.back();
    unfinished.path += kUnfinished;
    unfinished.shown += kUnfinished;
    touched.push_back(unfinished);
  }
  add(Use::kFrames, files.frame_folder, fullPath(files.frame_folder));
  return touched;
}

}  // namespace

std::string followLinks(const std::string& path) {
  fs::path target(path);
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(target, error); ++i) {
    target = target.parent_path() / fs::read_symlink(target, error);
  }
  return target.string();
}

void checkTouchedFiles(const TouchedFiles& files) {
  const std::vector<Touched> touched = listTouched(files);
  for (const Touched& a : touched) {
    for (const Touched& b : touched) {
      if (&a != &b && affects(a, b)) refuse(a, b);
    }
  }
}

}  // namespace spring_pendulum

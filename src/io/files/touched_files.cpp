#include "io/files/touched_files.hpp"

#include "io/files/frame_folder.hpp"
#include "io/files/posix.hpp"
#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <unistd.h>

namespace spring_pendulum {
namespace {

namespace fs = std::filesystem;

/// A file or folder, which need not exist.
struct Touched {
  enum Use { kInput, kStream, kOutput, kFrames } use;
  std::string shown;  ///< for messages
  fs::path path;      ///< without links
};

fs::path withoutLinks(const std::string& path) {
  std::error_code ignored;  // whoever opens the file reports it
  const fs::path target = fs::absolute(followLinks(path), ignored);
  fs::path canonical = fs::weakly_canonical(target, ignored).lexically_normal();
  if (!canonical.has_filename()) canonical = canonical.parent_path();
  return canonical.empty() ? target : canonical;
}

bool areSame(const fs::path& a, const fs::path& b) {
  struct stat status_a {};
  struct stat status_b {};
  return a == b || (::lstat(a.c_str(), &status_a) == 0 && ::lstat(b.c_str(), &status_b) == 0 &&
                    isSameFile(status_a, status_b));
}

bool isInside(const fs::path& path, const fs::path& folder) {
  const std::string start = folder.string() + '/';
  return path.string().compare(0, start.size(), start) == 0;
}

/// Throws if writing `a` would change or remove `b`.
void checkPair(const Touched& a, const Touched& b) {
  const std::string name = b.path.filename().string();
  const bool is_frame = a.use == Touched::kFrames && areSame(b.path.parent_path(), a.path) &&
                        (isFrameName(name) || name == hiddenName(kFramesLock));
  if (is_frame) {
    throw InputError(
        fmt::format("{}: has the name of a frame; choose another folder for the frames", b.shown));
  }
  if (a.use == Touched::kFrames && b.use != Touched::kOutput) return;
  const bool is_folder =
      a.use == Touched::kOutput && b.use >= Touched::kOutput && isInside(b.path, a.path);
  if (!areSame(a.path, b.path) && !is_folder) return;
  if (b.use == Touched::kInput) {
    if (areSame(withoutLinks("/proc/self/fd/2"), b.path))
      ::close(STDERR_FILENO);  // the message would change the input
    throw InputError(a.shown +
                     ": is an input of this run and would be overwritten; choose another file");
  }
  if (a.use == Touched::kStream) return;
  if (b.use == Touched::kStream) {
    throw FileError(a.shown + ": is a standard stream of this program; give another file");
  }
  throw InputError(a.shown + (is_folder ? ": is the folder of another output; give a file"
                                        : ": is given for two outputs; choose another file"));
}

}  // namespace

TouchedFiles touchedFiles(const Scenario& scenario, const std::string& config) {
  return {{scenario.particles, config},
          {scenario.energy, scenario.save_state},
          scenario.no_frames ? "" : scenario.output};
}

void checkTouchedFiles(const TouchedFiles& files) {
  std::vector<Touched> touched;
  const auto add = [&touched](Touched::Use use, const std::string& path, const std::string& shown) {
    if (!path.empty()) touched.push_back({use, shown, withoutLinks(path)});
  };
  for (const std::string& input : files.inputs) add(Touched::kInput, input, fullPath(input));
  const char* const streams[] = {"standard input", "standard output", "standard error"};
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    struct stat status {};
    if (::fstat(stream, &status) != 0 || !S_ISREG(status.st_mode)) continue;
    add(stream == STDIN_FILENO ? Touched::kInput : Touched::kStream,
        fmt::format("/proc/self/fd/{}", stream), streams[stream]);
  }
  for (const std::string& output : files.outputs) {
    if (output.empty()) continue;
    add(Touched::kOutput, output, fullPath(output));
    Touched hidden = touched.back();
    hidden.path.replace_filename(hiddenName(hidden.path.filename().string()));
    touched.push_back(hidden);
  }
  add(Touched::kFrames, files.frame_folder, fullPath(files.frame_folder));
  for (const Touched& a : touched) {
    for (const Touched& b : touched) {
      if (&a != &b && a.use != Touched::kInput) checkPair(a, b);
    }
  }
}

}  // namespace spring_pendulum

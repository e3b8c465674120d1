#include "io/files/paths.hpp"

#include <spring_pendulum/base/errors.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

namespace spring_pendulum {

std::string fullPath(const std::string& path) {
  std::error_code error;
  const std::filesystem::path full = std::filesystem::absolute(path, error);
  if (error) return path;
  std::string normal = full.lexically_normal().string();
  if (normal.size() > 1 && normal.back() == '/') normal.pop_back();
  if (path.find("..") == std::string::npos) return normal;
  return std::filesystem::equivalent(full, normal, error) ? normal : full.string();
}

std::string messageForErrno() {
  return std::generic_category().message(errno);
}

std::string followLinks(const std::string& path) {
  constexpr int kMostLinks = 40;  // the limit of Linux
  std::filesystem::path target(path);
  std::error_code error;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(target, error); ++i) {
    target = target.parent_path() / std::filesystem::read_symlink(target, error);
  }
  return target.string();
}

std::vector<std::string> namesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (const std::filesystem::directory_iterator end; !error && entry != end;) {
    names.push_back(entry->path().filename().string());
    entry.increment(error);
  }
  if (!error) return names;
  throw FileError(fmt::format("{}: could not be read: {}", fullPath(folder), error.message()));
}

}  // namespace spring_pendulum

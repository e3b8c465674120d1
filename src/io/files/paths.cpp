#include "io/files/paths.hpp"

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

bool leadsTo(const std::string& path, int descriptor) {
  struct stat by_path {};
  struct stat opened {};
  return ::stat(path.c_str(), &by_path) == 0 && ::fstat(descriptor, &opened) == 0 &&
         isSameFile(by_path, opened);
}

}  // namespace spring_pendulum

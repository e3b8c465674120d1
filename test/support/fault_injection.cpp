// Preloaded into a program: makes one of its system calls fail, ends the program at this call, or
// moves its clock. Counts only calls for files below one folder. Environment variables:
//
//   FAULT_FOLDER  absolute path of the folder
//   FAULT_CALL    number of the call, counted from 1
//   FAULT_KIND    fail: this call fails; broken: this and all later calls fail; kill: the program
//                 ends before the call; short: a read or write transfers half of its bytes; again:
//                 a signal interrupts a read or write. The last two count only reads and writes. list:
//                 nothing fails, and the names of all calls are reported.
//   FAULT_REPORT  file outside the folder to which the name of the call is written
//   FAULT_THREAD  number of the thread that can't be created, counted from 1; with the kind broken, no
//                 later one either
//   CLOCK_BACK    s by which the system clock steps back, one second after the start
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <string>
#include <string_view>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

namespace {

std::string_view setting(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// 0 if not set.
long numberIn(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? 0 : std::strtol(value, nullptr, 10);
}

template <typename Function>
Function next(Function, const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::string linkOf(const std::string& path) {
  char text[4096];
  const ssize_t size = readlink(path.c_str(), text, sizeof text);
  return size > 0 ? std::string(text, static_cast<std::size_t>(size)) : "";
}

std::string pathOf(int descriptor) {
  return linkOf("/proc/self/fd/" + std::to_string(descriptor));
}

std::string pathOf(int folder, const char* path) {
  if (std::strncmp(path, "/proc/self/fd/", 14) == 0) return linkOf(path);
  if (path[0] == '/') return path;
  return (folder == AT_FDCWD ? linkOf("/proc/self/cwd") : pathOf(folder)) + "/" + path;
}

void report(const char* call) {
  const std::string path(setting("FAULT_REPORT"));
  const long file =
      syscall(SYS_openat, AT_FDCWD, path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  syscall(SYS_write, file, call, std::strlen(call));
  syscall(SYS_close, file);
}

enum class Fault { kNone, kFail, kShort };

/// The effect on a call.
Fault faultOf(const char* call, const std::string& path, bool moves_data = false) {
  static std::atomic<int> calls{0};
  const std::string_view folder = setting("FAULT_FOLDER");
  const std::string_view kind = setting("FAULT_KIND");
  if (folder.empty() || path.compare(0, folder.size(), folder) != 0) return Fault::kNone;
  if (kind == "list") {
    report((std::string(call) + "\n").c_str());
    return Fault::kNone;
  }
  const bool needs_data = kind == "short" || kind == "again";
  if (needs_data && !moves_data) return Fault::kNone;
  const long wanted = numberIn("FAULT_CALL");
  const int number = ++calls;
  if (number < wanted || (number > wanted && kind != "broken")) return Fault::kNone;
  if (number == wanted) report(call);
  if (kind == "kill") kill(getpid(), SIGKILL);
  errno = kind == "again" ? EINTR : EIO;
  return kind == "short" ? Fault::kShort : Fault::kFail;
}

bool fails(const char* call, const std::string& path) {
  return faultOf(call, path) == Fault::kFail;
}

/// Number of bytes of a read or write; -1 if it fails.
ssize_t allowed(const char* call, int file, std::size_t size) {
  const Fault fault = faultOf(call, pathOf(file), true);
  if (fault == Fault::kFail) return -1;
  return static_cast<ssize_t>(fault == Fault::kShort && size > 1 ? size / 2 : size);
}

mode_t modeOf(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

timespec clockNow(clockid_t clock) {
  timespec time{};
  syscall(SYS_clock_gettime, clock, &time);
  static const timespec kStart = time;
  const bool is_real = clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
  if (is_real && time.tv_sec > kStart.tv_sec + 1) time.tv_sec -= numberIn("CLOCK_BACK");
  return time;
}

}  // namespace

// The names are those of the system.
// NOLINTBEGIN(readability-identifier-naming,bugprone-macro-parentheses)
#define NEXT(function) next(&::function, #function)

// Programs compiled with large file support call functions with 64 in their name.
#define OPEN(function)                                       \
  int function(const char* path, int flags, ...) {           \
    va_list arguments;                                       \
    va_start(arguments, flags);                              \
    const mode_t mode = modeOf(flags, arguments);            \
    va_end(arguments);                                       \
    if (fails(#function, pathOf(AT_FDCWD, path))) return -1; \
    return NEXT(function)(path, flags, mode);                \
  }
#define OPENAT(function)                                       \
  int function(int folder, const char* path, int flags, ...) { \
    va_list arguments;                                         \
    va_start(arguments, flags);                                \
    const mode_t mode = modeOf(flags, arguments);              \
    va_end(arguments);                                         \
    if (fails(#function, pathOf(folder, path))) return -1;     \
    return NEXT(function)(folder, path, flags, mode);          \
  }
#define FOPEN(function)                                           \
  FILE* function(const char* path, const char* mode) {            \
    if (fails(#function, pathOf(AT_FDCWD, path))) return nullptr; \
    return NEXT(function)(path, mode);                            \
  }
#define STAT(function, Status)                               \
  int function(const char* path, Status* status) noexcept {  \
    if (fails(#function, pathOf(AT_FDCWD, path))) return -1; \
    return NEXT(function)(path, status);                     \
  }
#define FSTAT(function, Status)                     \
  int function(int file, Status* status) noexcept { \
    if (fails(#function, pathOf(file))) return -1;  \
    return NEXT(function)(file, status);            \
  }
#define FSTATAT(function, Status)                                                  \
  int function(int folder, const char* path, Status* status, int flags) noexcept { \
    if (fails(#function, pathOf(folder, path))) return -1;                         \
    return NEXT(function)(folder, path, status, flags);                            \
  }

extern "C" {

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
FOPEN(fopen)
FOPEN(fopen64)
STAT(stat, struct stat)
STAT(stat64, struct stat64)
FSTAT(fstat, struct stat)
FSTAT(fstat64, struct stat64)
FSTATAT(fstatat, struct stat)
FSTATAT(fstatat64, struct stat64)

ssize_t write(int file, const void* data, size_t size) {
  const ssize_t part = allowed("write", file, size);
  return part < 0 ? -1 : NEXT(write)(file, data, static_cast<size_t>(part));
}

ssize_t read(int file, void* data, size_t size) {
  const ssize_t part = allowed("read", file, size);
  return part < 0 ? -1 : NEXT(read)(file, data, static_cast<size_t>(part));
}

size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  if (fails("fwrite", pathOf(fileno(file)))) return 0;
  return NEXT(fwrite)(data, size, count, file);
}

int fflush(FILE* file) {
  if (file != nullptr && fails("fflush", pathOf(fileno(file)))) return EOF;
  return NEXT(fflush)(file);
}

int fseeko(FILE* file, off_t offset, int from) {
  if (fails("fseeko", pathOf(fileno(file)))) return -1;
  return NEXT(fseeko)(file, offset, from);
}

// A failing close still closes the descriptor, as on Linux, but data may be lost.
int fclose(FILE* file) {
  const bool failed = fails("fclose", pathOf(fileno(file)));
  const int cause = errno;
  const int result = NEXT(fclose)(file);
  if (failed) errno = cause;
  return failed ? EOF : result;
}

int close(int file) {
  const bool failed = fails("close", pathOf(file));
  const int cause = errno;
  const int result = NEXT(close)(file);
  if (failed) errno = cause;
  return failed ? -1 : result;
}

int fcntl(int file, int command, ...) {
  va_list arguments;
  va_start(arguments, command);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  if (command == F_DUPFD_CLOEXEC && fails("fcntl", pathOf(file))) return -1;
  return NEXT(fcntl)(file, command, argument);
}

int rename(const char* from, const char* to) noexcept {
  return fails("rename", pathOf(AT_FDCWD, to)) ? -1 : NEXT(rename)(from, to);
}

int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  if (fails("renameat", pathOf(to_folder, to))) return -1;
  return NEXT(renameat)(from_folder, from, to_folder, to);
}

int unlink(const char* path) noexcept {
  return fails("unlink", pathOf(AT_FDCWD, path)) ? -1 : NEXT(unlink)(path);
}

int remove(const char* path) noexcept {
  return fails("remove", pathOf(AT_FDCWD, path)) ? -1 : NEXT(remove)(path);
}

int unlinkat(int folder, const char* path, int flags) noexcept {
  return fails("unlinkat", pathOf(folder, path)) ? -1 : NEXT(unlinkat)(folder, path, flags);
}

int mkdir(const char* path, mode_t mode) noexcept {
  return fails("mkdir", pathOf(AT_FDCWD, path)) ? -1 : NEXT(mkdir)(path, mode);
}

int ftruncate(int file, off_t size) noexcept {
  return fails("ftruncate", pathOf(file)) ? -1 : NEXT(ftruncate)(file, size);
}

int flock(int file, int operation) noexcept {
  return fails("flock", pathOf(file)) ? -1 : NEXT(flock)(file, operation);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  static std::atomic<long> threads{0};
  const long wanted = numberIn("FAULT_THREAD"), number = ++threads;
  const bool later = setting("FAULT_KIND") == "broken" && wanted > 0 && number > wanted;
  if (number == wanted || later) return EAGAIN;
  return NEXT(pthread_create)(thread, attributes, start, argument);
}

int fsync(int file) {
  return fails("fsync", pathOf(file)) ? -1 : NEXT(fsync)(file);
}

int faccessat(int folder, const char* path, int mode, int flags) noexcept {
  if (fails("faccessat", pathOf(folder, path))) return -1;
  return NEXT(faccessat)(folder, path, mode, flags);
}

DIR* fdopendir(int file) {
  return fails("fdopendir", pathOf(file)) ? nullptr : NEXT(fdopendir)(file);
}

dirent* readdir(DIR* folder) {
  return fails("readdir", pathOf(dirfd(folder))) ? nullptr : NEXT(readdir)(folder);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  *time = clockNow(clock);
  return 0;
}

int gettimeofday(timeval* time, void*) noexcept {
  const timespec now = clockNow(CLOCK_REALTIME);
  *time = {now.tv_sec, now.tv_nsec / 1000};
  return 0;
}

time_t time(time_t* result) noexcept {
  const time_t now = clockNow(CLOCK_REALTIME).tv_sec;
  if (result != nullptr) *result = now;
  return now;
}

}  // extern "C"
// NOLINTEND(readability-identifier-naming,bugprone-macro-parentheses)

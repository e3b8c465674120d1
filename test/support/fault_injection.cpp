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
  if (kind == "unlocked") {  // a file system without locks
    errno = ENOSYS;
    return std::strcmp(call, "flock") == 0 ? Fault::kFail : Fault::kNone;
  }
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

// The names are those of the system. NOLINTBEGIN(readability-identifier-naming,bugprone-macro-parentheses)
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
#define HERE pathOf(AT_FDCWD, path)
// A function that calls the next one of its name with these arguments unless it fails.
#define CALL(Result, function, failure, path_of, parameters, ...)               \
  Result function parameters {                                                  \
    return fails(#function, path_of) ? (failure) : NEXT(function)(__VA_ARGS__); \
  }

extern "C" {

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
CALL(FILE*, fopen, nullptr, HERE, (const char* path, const char* mode), path, mode)
CALL(FILE*, fopen64, nullptr, HERE, (const char* path, const char* mode), path, mode)
CALL(int, stat, -1, HERE, (const char* path, struct stat* to) noexcept, path, to)
CALL(int, stat64, -1, HERE, (const char* path, struct stat64* to) noexcept, path, to)
CALL(int, fstat, -1, pathOf(file), (int file, struct stat* to) noexcept, file, to)
CALL(int, fstat64, -1, pathOf(file), (int file, struct stat64* to) noexcept, file, to)
CALL(int, fstatat, -1, pathOf(folder, path),
     (int folder, const char* path, struct stat* to, int flags) noexcept, folder, path, to, flags)
CALL(int, fstatat64, -1, pathOf(folder, path),
     (int folder, const char* path, struct stat64* to, int flags) noexcept, folder, path, to, flags)
CALL(int, faccessat, -1, pathOf(folder, path),
     (int folder, const char* path, int mode, int flags) noexcept, folder, path, mode, flags)
CALL(size_t, fwrite, 0, pathOf(fileno(file)),
     (const void* data, size_t size, size_t count, FILE* file), data, size, count, file)
CALL(int, fseeko, -1, pathOf(fileno(file)), (FILE * file, off_t offset, int from), file, offset,
     from)
CALL(int, rename, -1, HERE, (const char* from, const char* path) noexcept, from, path)
CALL(int, renameat, -1, pathOf(to, path),
     (int from, const char* old, int to, const char* path) noexcept, from, old, to, path)
CALL(int, unlink, -1, HERE, (const char* path) noexcept, path)
CALL(int, remove, -1, HERE, (const char* path) noexcept, path)
CALL(int, unlinkat, -1, pathOf(folder, path), (int folder, const char* path, int flags) noexcept,
     folder, path, flags)
CALL(int, mkdir, -1, HERE, (const char* path, mode_t mode) noexcept, path, mode)
CALL(int, ftruncate, -1, pathOf(file), (int file, off_t size) noexcept, file, size)
CALL(int, flock, -1, pathOf(file), (int file, int operation) noexcept, file, operation)
CALL(int, fsync, -1, pathOf(file), (int file), file)
CALL(DIR*, fdopendir, nullptr, pathOf(file), (int file), file)
CALL(dirent*, readdir, nullptr, pathOf(dirfd(folder)), (DIR * folder), folder)

ssize_t write(int file, const void* data, size_t size) {
  const ssize_t part = allowed("write", file, size);
  return part < 0 ? -1 : NEXT(write)(file, data, static_cast<size_t>(part));
}

ssize_t read(int file, void* data, size_t size) {
  const ssize_t part = allowed("read", file, size);
  return part < 0 ? -1 : NEXT(read)(file, data, static_cast<size_t>(part));
}

int fflush(FILE* file) {
  if (file != nullptr && fails("fflush", pathOf(fileno(file)))) return EOF;
  return NEXT(fflush)(file);
}

// A failing close still closes the descriptor, as on Linux, but data may be lost.
int fclose(FILE* file) {
  const bool failed = fails("fclose", pathOf(fileno(file)));
  const int cause = errno, result = NEXT(fclose)(file);
  if (failed) errno = cause;
  return failed ? EOF : result;
}

int close(int file) {
  const bool failed = fails("close", pathOf(file));
  const int cause = errno, result = NEXT(close)(file);
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

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  static std::atomic<long> threads{0};
  const long wanted = numberIn("FAULT_THREAD"), number = ++threads;
  const bool later = setting("FAULT_KIND") == "broken" && wanted > 0 && number > wanted;
  if (number == wanted || later) return EAGAIN;
  return NEXT(pthread_create)(thread, attributes, start, argument);
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

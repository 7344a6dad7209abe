// Preloaded into a program (LD_PRELOAD), makes one of its calls that change files fail as on a full disk, so that every
// such call of a run can be made to fail in turn. Counted are open for writing, write, pwrite, ftruncate, fsync,
// fdatasync and rename of files below one folder.
//   FT_FAIL_FOLDER=DIR    count calls on files below DIR (absolute, without symbolic links)
//   FT_FAIL_AT=N          the Nth such call, from 1, fails with ENOSPC; without it none fails
//   FT_FAIL_KEEP=1        and so do all that follow: the disk stays full
//   FT_FAIL_KILL=1        instead of failing, the process dies as by kill -9 just before the call
//   FT_FAIL_SHORT=1       a failing write writes half of its bytes first
//   FT_COUNT_FILE=PATH    receives the number of calls so far, always as the last thing; outside DIR
// Careful: nothing here may allocate or use the wrapped calls; it also works before main and in child processes.
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

std::atomic<long> calls{0};

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

bool below_folder(const char* path) {
  const char* folder = std::getenv("FT_FAIL_FOLDER");
  if (folder == nullptr || path == nullptr) return false;
  char absolute[2 * PATH_MAX];
  if (path[0] != '/') {
    if (::getcwd(absolute, PATH_MAX) == nullptr) return false;
    const std::size_t length = std::strlen(absolute);
    std::snprintf(absolute + length, sizeof absolute - length, "/%s", path);
    path = absolute;
  }
  const std::size_t length = std::strlen(folder);
  return std::strncmp(path, folder, length) == 0 && (path[length] == '/' || path[length] == '\0');
}

bool below_folder(int descriptor) {
  char link[64], path[PATH_MAX];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = ::readlink(link, path, sizeof path - 1);
  if (length <= 0) return false;
  path[length] = '\0';
  return below_folder(path);
}

void write_count(long count) {
  const char* path = std::getenv("FT_COUNT_FILE");
  if (path == nullptr) return;
  const long fd = ::syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) return;
  char text[32];
  const int length = std::snprintf(text, sizeof text, "%012ld\n", count);
  [[maybe_unused]] const long written = ::syscall(SYS_pwrite64, fd, text, length, 0L);
  ::syscall(SYS_close, fd);
}

/// One more call; true when it must fail.
bool fails_now() {
  const long count = ++calls;
  write_count(count);
  const char* at = std::getenv("FT_FAIL_AT");
  if (at == nullptr) return false;
  const long wanted = std::atol(at);
  if (std::getenv("FT_FAIL_KILL") != nullptr && count == wanted) ::kill(::getpid(), SIGKILL);
  return count == wanted || (count > wanted && wanted > 0 && std::getenv("FT_FAIL_KEEP") != nullptr);
}

template <class Integer = int>
Integer full() {
  errno = ENOSPC;
  return -1;
}

std::size_t short_size(std::size_t size) {
  return std::getenv("FT_FAIL_SHORT") != nullptr ? size / 2 : 0;
}

bool opens_for_writing(int flags) {
  return (flags & O_ACCMODE) != O_RDONLY || (flags & (O_CREAT | O_TRUNC)) != 0;
}

int open_mode(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, int) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = open_mode(flags, arguments);
  va_end(arguments);
  if (opens_for_writing(flags) && below_folder(path) && fails_now()) return full();
  static const auto real = next<int (*)(const char*, int, ...)>("open");
  return real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int mode = open_mode(flags, arguments);
  va_end(arguments);
  if (opens_for_writing(flags) && below_folder(path) && fails_now()) return full();
  static const auto real = next<int (*)(const char*, int, ...)>("open64");
  return real(path, flags, mode);
}

FILE* fopen(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr && below_folder(path) && fails_now()) {
    errno = ENOSPC;
    return nullptr;
  }
  static const auto real = next<FILE* (*)(const char*, const char*)>("fopen");
  return real(path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  if (std::strpbrk(mode, "wa+") != nullptr && below_folder(path) && fails_now()) {
    errno = ENOSPC;
    return nullptr;
  }
  static const auto real = next<FILE* (*)(const char*, const char*)>("fopen64");
  return real(path, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  if (below_folder(descriptor) && fails_now()) {
    if (short_size(size) > 0 && real(descriptor, data, short_size(size)) < 0) return -1;
    return full<ssize_t>();
  }
  return real(descriptor, data, size);
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite");
  if (below_folder(descriptor) && fails_now()) {
    if (short_size(size) > 0 && real(descriptor, data, short_size(size), offset) < 0) return -1;
    return full<ssize_t>();
  }
  return real(descriptor, data, size, offset);
}

ssize_t pwrite64(int descriptor, const void* data, size_t size, off64_t offset) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  if (below_folder(descriptor) && fails_now()) {
    if (short_size(size) > 0 && real(descriptor, data, short_size(size), offset) < 0) return -1;
    return full<ssize_t>();
  }
  return real(descriptor, data, size, offset);
}

int fsync(int descriptor) {
  static const auto real = next<int (*)(int)>("fsync");
  return below_folder(descriptor) && fails_now() ? full() : real(descriptor);
}

int fdatasync(int descriptor) {
  static const auto real = next<int (*)(int)>("fdatasync");
  return below_folder(descriptor) && fails_now() ? full() : real(descriptor);
}

int ftruncate(int descriptor, off_t size) {
  static const auto real = next<int (*)(int, off_t)>("ftruncate");
  return below_folder(descriptor) && fails_now() ? full() : real(descriptor, size);
}

int ftruncate64(int descriptor, off64_t size) {
  static const auto real = next<int (*)(int, off64_t)>("ftruncate64");
  return below_folder(descriptor) && fails_now() ? full() : real(descriptor, size);
}

int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return below_folder(to) && fails_now() ? full() : real(from, to);
}

}  // extern "C"

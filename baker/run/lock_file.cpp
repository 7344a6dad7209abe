#include "baker/run/lock_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace ft::inline baker {

Result<LockFile> LockFile::acquire(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0)
    return output_error(std::string("the output folder cannot be written: ") + std::strerror(errno),
                        path.parent_path().parent_path().string(), "choose another folder with --out");
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    char holder[128] = {};
    const ssize_t n = ::pread(fd, holder, sizeof holder - 1, 0);
    ::close(fd);
    return output_error("another bake is writing this folder" + (n > 0 ? ": " + std::string(holder) : std::string()),
                        path.parent_path().parent_path().string(), "wait for it, or choose another folder with --out");
  }
  char host[96] = {};
  ::gethostname(host, sizeof host - 1);
  const std::string text = "process " + std::to_string(::getpid()) + " on " + host;
  // A full disk must not keep a bake from being inspected or resumed: the words are only for the message above.
  if (::ftruncate(fd, 0) == 0 && ::pwrite(fd, text.data(), text.size(), 0) < 0) errno = 0;
  return LockFile(fd);
}

LockFile::LockFile(LockFile&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

LockFile::~LockFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace ft::inline baker

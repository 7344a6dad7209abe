// One bake at a time writes a folder. The lock is the kernel's (flock), so a killed bake leaves none behind; the file
// says which process holds it. Where the file system knows no locks, the bake goes on without.
#pragma once

#include <filesystem>

#include "baker/core/result.h"

namespace ft::inline baker {

class LockFile {
 public:
  static Result<LockFile> acquire(const std::filesystem::path& path);
  LockFile(LockFile&& other) noexcept;
  LockFile& operator=(LockFile&&) = delete;
  ~LockFile();

 private:
  explicit LockFile(int descriptor) : descriptor_(descriptor) {}
  int descriptor_ = -1;
};

}  // namespace ft::inline baker

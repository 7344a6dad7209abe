// A file opened for reading at given offsets, for caches that are too large to be read whole and that may still be
// growing. Not memory-mapped on purpose: a mapped file that is cut while it is read ends the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "baker/core/result.h"

namespace ft::inline io {

class InputFile {
 public:
  static Result<InputFile> open(const std::filesystem::path& path);

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  /// Size when it was opened [bytes].
  std::uint64_t size() const { return size_; }
  const std::filesystem::path& path() const { return path_; }
  /// Fills data from offset on; false when that many bytes are not there.
  bool read_at(std::uint64_t offset, std::span<std::byte> data) const;

 private:
  InputFile(int descriptor, std::uint64_t size, std::filesystem::path path)
      : descriptor_(descriptor), size_(size), path_(std::move(path)) {}
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::filesystem::path path_;
};

}  // namespace ft::inline io

// The only door to the disk. Whole files appear by temp-and-rename; growing files are written through OutputFile, whose
// every failure is an Error with the path, the system's reason and what to try.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "baker/core/bytes.h"
#include "baker/core/hash.h"
#include "baker/core/result.h"

namespace ft {

/// Largest file that is read whole, unless a caller says otherwise [bytes].
inline constexpr std::uint64_t k_max_file_bytes = std::uint64_t{4} << 30;

Result<Bytes> read_file(const std::filesystem::path& path, std::uint64_t max_bytes = k_max_file_bytes);
/// Of a whole file, without ever holding more than a little of it.
struct FileContent {
  std::uint64_t bytes = 0;
  Hash128 hash;  ///< as hash_bytes() of all of them
};
Result<FileContent> hash_file(const std::filesystem::path& path);
Result<std::string> read_text(const std::filesystem::path& path, std::uint64_t max_bytes = k_max_file_bytes);

/// Writes path.tmp, syncs it, renames it over path, syncs the folder: after a crash there is the old file or the new
/// one.
Status write_file_durably(const std::filesystem::path& path, std::span<const std::byte> data);
/// All parts, one behind the other.
Status write_file_durably(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts);
Status write_text_durably(const std::filesystem::path& path, std::string_view text);

Status make_folders(const std::filesystem::path& folder);

/// An open file that is written at given offsets. Close it to learn of late failures; the destructor closes silently.
class OutputFile {
 public:
  static Result<OutputFile> create(const std::filesystem::path& path);         ///< new or emptied
  static Result<OutputFile> open_existing(const std::filesystem::path& path);  ///< kept as it is, for resume

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  Status write_at(std::uint64_t offset, std::span<const std::byte> data);
  Status truncate(std::uint64_t size);
  Result<std::uint64_t> size() const;
  Status sync();
  Status close();
  const std::filesystem::path& path() const { return path_; }

 private:
  OutputFile(int descriptor, std::filesystem::path path) : descriptor_(descriptor), path_(std::move(path)) {}
  int descriptor_ = -1;
  std::filesystem::path path_;
};

}  // namespace ft

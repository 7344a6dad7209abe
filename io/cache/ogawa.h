// Ogawa, the container of Alembic files: data nodes (u64 size, payload) and group nodes (u64 count, references),
// anywhere in the file, found through references from one root group. Builder lays nodes out in memory for a given
// place in the file; Source reads them back. After the first fault every read of Source gives nothing and fault() says
// what, so that a parser looks once.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "baker/core/bytes.h"
#include "io/cache/input_file.h"

namespace ft::inline io::ogawa {

/// File offset of a node; the top bit says that it is data.
using Reference = std::uint64_t;
inline constexpr Reference k_data_bit = Reference{1} << 63;
inline constexpr Reference k_empty_data = k_data_bit;
inline constexpr Reference k_empty_group = 0;
inline constexpr std::uint64_t k_header_size = 16;
inline constexpr std::uint64_t k_root_offset = 8;  ///< where the header keeps the position of the root group

/// The 16 bytes at the start of a complete file.
Bytes header(Reference root);

class Builder {
 public:
  /// Nodes will stand from this file offset on.
  explicit Builder(std::uint64_t base) : base_(base) {}
  Reference data(std::span<const std::byte> payload);
  Reference group(std::span<const Reference> children);
  std::uint64_t end() const { return base_ + out_.bytes().size(); }
  Bytes take() { return out_.take(); }

 private:
  std::uint64_t base_;
  ByteWriter out_;
};

class Source {
 public:
  /// Checks the header. What all groups and all data together may hold is capped by the size of the file, against
  /// groups that contain each other and data that is referred to again and again.
  explicit Source(const InputFile& file);

  bool ok() const { return fault_.empty(); }
  const std::string& fault() const { return fault_; }
  void fail(std::string what);

  Reference root() const { return root_; }
  std::vector<Reference> group(Reference reference);
  /// Size of a data node whose whole payload is inside the file [bytes].
  std::uint64_t data_size(Reference reference);
  /// Payload from the start, at most max_size bytes of it; a shorter node gives what it has.
  Bytes data(Reference reference, std::uint64_t max_size);

 private:
  /// Through a window, because an archive is thousands of small nodes.
  bool read_at(std::uint64_t offset, std::span<std::byte> out);

  const InputFile& file_;
  Bytes window_;
  std::uint64_t window_offset_ = 0;
  std::uint64_t references_left_, bytes_left_;
  Reference root_ = 0;
  std::string fault_;
};

}  // namespace ft::inline io::ogawa

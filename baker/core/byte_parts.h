// What a ByteWriter would hold, without a copy of what is large: parts, one behind the other, own ones and somebody
// else's. For files that are written, or hashed, out of what stands in memory already.
#pragma once

#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "baker/core/bytes.h"

namespace ft {

class ByteParts {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T> ByteParts& write(const T& value) { return write_raw(&value, sizeof(T)); }
  /// u32 length, then the characters.
  ByteParts& write_string(std::string_view s);
  /// Only looked at: the values must outlive this.
  template <class T>
  requires std::is_trivially_copyable_v<T> ByteParts& view_array(std::span<const T> values) {
    return view(std::as_bytes(values));
  }
  ByteParts& append(ByteParts other);

  /// Valid until the next call.
  std::span<const std::span<const std::byte>> parts();
  std::size_t size();
  Bytes joined();

 private:
  ByteParts& write_raw(const void* data, std::size_t size);
  ByteParts& view(std::span<const std::byte> bytes);
  void close_part();

  std::vector<std::span<const std::byte>> parts_;  ///< of owned_ or of somebody else
  std::vector<Bytes> owned_;
  Bytes end_;  ///< no part yet
};

}  // namespace ft

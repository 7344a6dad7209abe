// Content hashes (XXH3, 128 bits): of inputs for caching and staleness, of State for determinism and checkpoints.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace ft {

struct Hash128 {
  std::uint64_t low = 0, high = 0;
  bool operator==(const Hash128&) const = default;
  /// 32 lower-case hex digits, high word first.
  std::string hex() const;
};

class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  Hasher& bytes(const void* data, std::size_t size);
  /// Length first, then the characters, so that ("ab","c") differs from ("a","bc").
  Hasher& text(std::string_view s);
  template <class T>
  requires std::is_arithmetic_v<T> Hasher& number(T value) { return bytes(&value, sizeof value); }
  Hash128 digest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

Hash128 hash_bytes(std::span<const std::byte> data);
/// Of all parts, one behind the other.
Hash128 hash_bytes(std::span<const std::span<const std::byte>> parts);
Hash128 hash_text(std::string_view text);

}  // namespace ft

// MurmurHash3_x64_128 (A. Appleby, public domain), seed 0: the key that stands before every sample of an Alembic file.
// Readers use it to recognise equal data, so it must be exactly this function. Nothing else in the program uses it.
#pragma once

#include <cstdint>
#include <span>

#include "baker/core/bytes.h"

namespace ft::inline io::alembic {

struct Key {
  std::uint64_t h1 = 0, h2 = 0;
  bool operator==(const Key&) const = default;
};

Key murmur3(std::span<const std::byte> data);

}  // namespace ft::inline io::alembic

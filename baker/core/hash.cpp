#include "baker/core/hash.h"

#include <xxhash.h>

#include <cstdio>

namespace ft {

struct Hasher::Impl {
  XXH3_state_t* state = XXH3_createState();
  ~Impl() { XXH3_freeState(state); }
};

std::string Hash128::hex() const {
  char out[33];
  std::snprintf(out, sizeof out, "%016llx%016llx", static_cast<unsigned long long>(high),
                static_cast<unsigned long long>(low));
  return out;
}

Hasher::Hasher() : impl_(new Impl) {
  XXH3_128bits_reset(impl_->state);
}
Hasher::~Hasher() = default;

Hasher& Hasher::bytes(const void* data, std::size_t size) {
  if (size > 0) XXH3_128bits_update(impl_->state, data, size);
  return *this;
}

Hasher& Hasher::text(std::string_view s) {
  number(static_cast<std::uint64_t>(s.size()));
  return bytes(s.data(), s.size());
}

Hash128 Hasher::digest() const {
  const XXH128_hash_t h = XXH3_128bits_digest(impl_->state);
  return {h.low64, h.high64};
}

Hash128 hash_bytes(std::span<const std::byte> data) {
  const XXH128_hash_t h = XXH3_128bits(data.data(), data.size());
  return {h.low64, h.high64};
}

Hash128 hash_bytes(std::span<const std::span<const std::byte>> parts) {
  Hasher hasher;
  for (const auto& part : parts) hasher.bytes(part.data(), part.size());
  return hasher.digest();
}

Hash128 hash_text(std::string_view text) {
  return hash_bytes(std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace ft

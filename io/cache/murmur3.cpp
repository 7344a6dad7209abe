// MurmurHash3_x64_128: see murmur3.h.
#include "io/cache/murmur3.h"

#include <bit>

namespace ft::inline io::alembic {
namespace {

constexpr std::uint64_t k_c1 = 0x87c37b91114253d5u, k_c2 = 0x4cf5ad432745937fu;

std::uint64_t finish(std::uint64_t k) {
  k = (k ^ (k >> 33)) * 0xff51afd7ed558ccdu;
  k = (k ^ (k >> 33)) * 0xc4ceb9fe1a85ec53u;
  return k ^ (k >> 33);
}

std::uint64_t mix1(std::uint64_t k) {
  return std::rotl(k * k_c1, 31) * k_c2;
}
std::uint64_t mix2(std::uint64_t k) {
  return std::rotl(k * k_c2, 33) * k_c1;
}

}  // namespace

Key murmur3(std::span<const std::byte> data) {
  std::uint64_t h1 = 0, h2 = 0;
  const std::size_t blocks = data.size() / 16;
  for (std::size_t i = 0; i < blocks; ++i) {
    std::uint64_t k[2];
    std::memcpy(k, data.data() + 16 * i, 16);
    h1 = (std::rotl(h1 ^ mix1(k[0]), 27) + h2) * 5 + 0x52dce729;
    h2 = (std::rotl(h2 ^ mix2(k[1]), 31) + h1) * 5 + 0x38495ab5;
  }
  const auto rest = data.subspan(16 * blocks);
  std::uint64_t k[2] = {0, 0};
  for (std::size_t i = 0; i < rest.size(); ++i) k[i / 8] |= std::to_integer<std::uint64_t>(rest[i]) << (8 * (i % 8));
  if (rest.size() > 8) h2 ^= mix2(k[1]);
  if (!rest.empty()) h1 ^= mix1(k[0]);
  h1 ^= data.size();
  h2 ^= data.size();
  h1 += h2;
  h2 += h1;
  h1 = finish(h1);
  h2 = finish(h2);
  h1 += h2;
  h2 += h1;
  return {h1, h2};
}

}  // namespace ft::inline io::alembic

// Random numbers without a hidden state: a value is a function of (seed, system, frame, element, draw). SplitMix64
// finaliser (Steele, Lea, Flood 2014) over the mixed keys.
#pragma once

#include <cstdint>

namespace ft {

constexpr std::uint64_t mix64(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

struct RandomKey {
  std::uint64_t seed = 0, system = 0, frame = 0, element = 0;
};

constexpr std::uint64_t random_bits(const RandomKey& key, std::uint64_t draw = 0) {
  return mix64(mix64(mix64(mix64(mix64(key.seed) ^ key.system) ^ key.frame) ^ key.element) ^ draw);
}

/// Uniform in [0, 1).
constexpr double random_uniform(const RandomKey& key, std::uint64_t draw = 0) {
  return static_cast<double>(random_bits(key, draw) >> 11) * 0x1.0p-53;
}

}  // namespace ft

#include "baker/commands/base64.h"

namespace ft::inline baker {

std::string base64(std::span<const std::byte> data) {
  constexpr const char* k_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((data.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < data.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < data.size() ? static_cast<unsigned>(data[i + k]) : 0u; };
    const unsigned bits = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > data.size() ? '=' : k_digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

}  // namespace ft::inline baker

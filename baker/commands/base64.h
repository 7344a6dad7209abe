// Numbers in a page's JSON: their bytes as base64, little-endian.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace ft::inline baker {

std::string base64(std::span<const std::byte> data);

template <class T>
std::string base64_of(const std::vector<T>& values) {
  return base64(std::as_bytes(std::span<const T>(values)));
}

}  // namespace ft::inline baker

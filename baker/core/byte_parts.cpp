#include "baker/core/byte_parts.h"

#include <utility>

namespace ft {

ByteParts& ByteParts::write_raw(const void* data, std::size_t size) {
  const auto* p = static_cast<const std::byte*>(data);
  end_.insert(end_.end(), p, p + size);
  return *this;
}

ByteParts& ByteParts::write_string(std::string_view s) {
  write(static_cast<std::uint32_t>(s.size()));
  return write_raw(s.data(), s.size());
}

ByteParts& ByteParts::view(std::span<const std::byte> bytes) {
  close_part();
  parts_.push_back(bytes);
  return *this;
}

ByteParts& ByteParts::append(ByteParts other) {
  close_part();
  other.close_part();
  parts_.insert(parts_.end(), other.parts_.begin(), other.parts_.end());
  for (Bytes& own : other.owned_) owned_.push_back(std::move(own));
  return *this;
}

std::span<const std::span<const std::byte>> ByteParts::parts() {
  close_part();
  return parts_;
}

std::size_t ByteParts::size() {
  std::size_t sum = 0;
  for (const auto& part : parts()) sum += part.size();
  return sum;
}

Bytes ByteParts::joined() {
  Bytes out;
  out.reserve(size());
  for (const auto& part : parts()) out.insert(out.end(), part.begin(), part.end());
  return out;
}

void ByteParts::close_part() {
  if (end_.empty()) return;
  owned_.push_back(std::exchange(end_, {}));
  parts_.push_back(owned_.back());
}

}  // namespace ft

// Bytes from outside. ByteReader checks every length before it believes it; after the first fault every read gives zero
// and ok() stays false, so that a parser can run through and look once. Little-endian unless the name says otherwise.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace ft {

static_assert(std::endian::native == std::endian::little, "formats are written for little-endian machines");

using Bytes = std::vector<std::byte>;

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> data) : data_(data) {}

  bool ok() const { return ok_; }
  std::size_t position() const { return position_; }
  std::size_t remaining() const { return data_.size() - position_; }
  std::size_t size() const { return data_.size(); }
  void fail() { ok_ = false; }
  void seek(std::size_t position) { position <= data_.size() ? void(position_ = position) : fail(); }

  template <class T>
  requires std::is_trivially_copyable_v<T> T read() {
    T value{};
    if (!ok_ || remaining() < sizeof(T)) {
      fail();
      return value;
    }
    std::memcpy(&value, data_.data() + position_, sizeof(T));
    position_ += sizeof(T);
    return value;
  }

  /// count values; refused (empty, fault) when fewer bytes remain, before anything is allocated.
  template <class T>
  requires std::is_trivially_copyable_v<T> std::vector<T> read_array(std::uint64_t count) {
    if (!ok_ || count > remaining() / sizeof(T)) {
      fail();
      return {};
    }
    std::vector<T> out(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(out.data(), data_.data() + position_, out.size() * sizeof(T));
    position_ += out.size() * sizeof(T);
    return out;
  }

  /// u32 length, then the characters.
  std::string read_string() {
    const auto length = read<std::uint32_t>();
    if (!ok_ || length > remaining()) {
      fail();
      return {};
    }
    std::string out(reinterpret_cast<const char*>(data_.data() + position_), length);
    position_ += length;
    return out;
  }

  std::span<const std::byte> read_span(std::uint64_t count) {
    if (!ok_ || count > remaining()) {
      fail();
      return {};
    }
    auto out = data_.subspan(position_, static_cast<std::size_t>(count));
    position_ += out.size();
    return out;
  }

 private:
  std::span<const std::byte> data_;
  std::size_t position_ = 0;
  bool ok_ = true;
};

class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T> ByteWriter& write(const T& value) { return write_raw(&value, sizeof(T)); }
  template <class T>
  requires std::is_trivially_copyable_v<T> ByteWriter& write_array(std::span<const T> values) {
    return write_raw(values.data(), values.size_bytes());
  }
  ByteWriter& write_string(std::string_view s) {
    write(static_cast<std::uint32_t>(s.size()));
    return write_raw(s.data(), s.size());
  }
  ByteWriter& write_raw(const void* data, std::size_t size) {
    const auto* p = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), p, p + size);
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }

 private:
  Bytes bytes_;
};

}  // namespace ft

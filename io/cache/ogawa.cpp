// Ogawa containers: see ogawa.h.
#include "io/cache/ogawa.h"

#include <algorithm>

namespace ft::inline io::ogawa {
namespace {

constexpr unsigned char k_magic[8] = {'O', 'g', 'a', 'w', 'a', 0xff, 0, 1};

}  // namespace

Bytes header(Reference root) {
  ByteWriter out;
  out.write_raw(k_magic, sizeof k_magic);
  out.write(root);
  return out.take();
}

Reference Builder::data(std::span<const std::byte> payload) {
  if (payload.empty()) return k_empty_data;
  const Reference reference = end() | k_data_bit;
  out_.write(static_cast<std::uint64_t>(payload.size())).write_array(payload);
  return reference;
}

Reference Builder::group(std::span<const Reference> children) {
  if (children.empty()) return k_empty_group;
  const Reference reference = end();
  out_.write(static_cast<std::uint64_t>(children.size())).write_array(children);
  return reference;
}

Source::Source(const InputFile& file)
    : file_(file), references_left_(file.size() / sizeof(Reference) + 1024), bytes_left_(2 * file.size() + (1u << 20)) {
  Bytes start(k_header_size);
  if (!file_.read_at(0, start)) {
    fail("is too short for an Alembic file");
  } else if (std::memcmp(start.data(), k_magic, 5) != 0) {
    fail("is not an Alembic (Ogawa) file");
  } else if (start[5] != std::byte{0xff}) {
    fail("was never finished by the program that wrote it");
  } else if (std::memcmp(start.data(), k_magic, sizeof k_magic) != 0) {
    fail("has an unknown version of Ogawa");
  } else {
    std::memcpy(&root_, start.data() + k_root_offset, sizeof root_);
  }
}

void Source::fail(std::string what) {
  if (ok()) fault_ = std::move(what);
}

bool Source::read_at(std::uint64_t offset, std::span<std::byte> out) {
  constexpr std::uint64_t k_window_size = 16384;
  if (offset > file_.size() || out.size() > file_.size() - offset) return false;
  if (out.size() > k_window_size) return file_.read_at(offset, out);
  if (offset < window_offset_ || offset + out.size() > window_offset_ + window_.size()) {
    window_.resize(static_cast<std::size_t>(std::min(k_window_size, file_.size() - offset)));
    window_offset_ = offset;
    if (!file_.read_at(offset, window_)) {
      window_.clear();
      return false;
    }
  }
  if (!out.empty()) std::memcpy(out.data(), window_.data() + (offset - window_offset_), out.size());
  return true;
}

std::vector<Reference> Source::group(Reference reference) {
  if (!ok() || reference == k_empty_group) return {};
  std::uint64_t count = 0;
  if ((reference & k_data_bit) != 0 || reference < k_header_size ||
      !read_at(reference, std::as_writable_bytes(std::span(&count, 1)))) {
    fail("is damaged or cut: a group lies outside the file");
    return {};
  }
  if (count > (file_.size() - reference - sizeof count) / sizeof(Reference) || count > references_left_) {
    fail("is damaged or cut: a group is larger than the file");
    return {};
  }
  references_left_ -= count;
  std::vector<Reference> children(static_cast<std::size_t>(count));
  if (!read_at(reference + sizeof count, std::as_writable_bytes(std::span(children)))) {
    fail("cannot be read");
    return {};
  }
  return children;
}

std::uint64_t Source::data_size(Reference reference) {
  if (!ok() || reference == k_empty_data) return 0;
  const std::uint64_t offset = reference & ~k_data_bit;
  std::uint64_t size = 0;
  if ((reference & k_data_bit) == 0 || offset < k_header_size ||
      !read_at(offset, std::as_writable_bytes(std::span(&size, 1))) || size > file_.size() - offset - sizeof size) {
    fail("is damaged or cut: data lies outside the file");
    return 0;
  }
  return size;
}

Bytes Source::data(Reference reference, std::uint64_t max_size) {
  const std::uint64_t size = std::min(data_size(reference), max_size);
  if (size > bytes_left_) {
    fail("is damaged: the same data is used too often");
    return {};
  }
  bytes_left_ -= size;
  Bytes out(static_cast<std::size_t>(size));
  if (size > 0 && !read_at((reference & ~k_data_bit) + sizeof size, out)) {
    fail("cannot be read");
    return {};
  }
  return out;
}

}  // namespace ft::inline io::ogawa

// Tree to bytes: groups bottom-up, so that every reference is known when it is written. Layout as the public Alembic
// library reads it (AbcCoreOgawa): see the names of the children at each group below.
#include <algorithm>

#include "io/cache/alembic_archive.h"

namespace ft::inline io::alembic {
namespace {

constexpr std::uint8_t k_inline_metadata = 255;
constexpr std::int32_t k_library_version = 10800;  // MMmmpp; readers accept what is at least 9999

std::span<const std::byte> bytes_of(const std::string& s) {
  return std::as_bytes(std::span(s.data(), s.size()));
}

/// Metadata strings are written once, in a table of at most 254 strings shorter than 256 bytes.
class MetadataTable {
 public:
  std::uint8_t index(const std::string& text) {
    if (text.empty()) return 0;
    const auto found = std::find(entries_.begin(), entries_.end(), text);
    if (found != entries_.end()) return static_cast<std::uint8_t>(found - entries_.begin() + 1);
    if (text.size() > 255 || entries_.size() >= 254) return k_inline_metadata;
    entries_.push_back(text);
    return static_cast<std::uint8_t>(entries_.size());
  }
  Bytes bytes() const {
    ByteWriter out;
    for (const std::string& e : entries_) out.write(static_cast<std::uint8_t>(e.size())).write_raw(e.data(), e.size());
    return out.take();
  }

 private:
  std::vector<std::string> entries_;
};

void write_header(ByteWriter& out, const Property& p, MetadataTable& table) {
  const bool compound = p.kind == PropertyKind::k_compound;
  const std::uint8_t metadata = table.index(p.metadata);
  std::uint64_t largest = std::max(p.name.size(), p.metadata.size());
  if (!compound) largest = std::max<std::uint64_t>({largest, p.sample_count, p.time_sampling});
  const std::uint32_t hint = largest < 256 ? 0 : largest < 65536 ? 1 : 2;
  const bool range = !p.constant() && (p.first_changed != 1 || p.last_changed + 1 != p.sample_count);

  std::uint32_t info = hint << 2 | std::uint32_t{metadata} << 20;
  if (!compound) {
    info |= p.kind == PropertyKind::k_scalar ? 1u : p.single_element ? 3u : 2u;
    info |= static_cast<std::uint32_t>(p.pod) << 4 | static_cast<std::uint32_t>(p.extent) << 12;
    info |= std::uint32_t{p.time_sampling != 0} << 8 | std::uint32_t{range} << 9;
    info |= std::uint32_t{p.homogeneous} << 10 | std::uint32_t{p.constant()} << 11;
  }
  const auto number = [&](std::uint64_t value) {
    if (hint == 0) out.write(static_cast<std::uint8_t>(value));
    if (hint == 1) out.write(static_cast<std::uint16_t>(value));
    if (hint == 2) out.write(static_cast<std::uint32_t>(value));
  };
  out.write(info);
  if (!compound) {
    number(p.sample_count);
    if (range) number(p.first_changed), number(p.last_changed);
    if (p.time_sampling != 0) number(p.time_sampling);
  }
  number(p.name.size());
  out.write_raw(p.name.data(), p.name.size());
  if (metadata == k_inline_metadata) {
    number(p.metadata.size());
    out.write_raw(p.metadata.data(), p.metadata.size());
  }
}

/// Children: one group per property, then their headers.
ogawa::Reference write_compound(ogawa::Builder& builder, std::span<const Property> properties, MetadataTable& table) {
  if (properties.empty()) return ogawa::k_empty_group;
  std::vector<ogawa::Reference> children;
  ByteWriter headers;
  for (const Property& p : properties) {
    if (p.kind == PropertyKind::k_compound) {
      children.push_back(write_compound(builder, p.children, table));
    } else {
      std::vector<ogawa::Reference> slots;
      for (const Sample& s : p.samples) {
        slots.push_back(s.data);
        if (p.kind == PropertyKind::k_array) slots.push_back(s.dimensions);
      }
      children.push_back(builder.group(slots));
    }
    write_header(headers, p, table);
  }
  children.push_back(builder.data(headers.bytes()));
  return builder.group(children);
}

void write_hash(ByteWriter& out, const Hash128& hash) {
  out.write(hash.low).write(hash.high);
}

/// Children: the properties, one group per child object, then their headers and this object's two hashes.
ogawa::Reference write_object(ogawa::Builder& builder, const Object& object, std::span<const TimeSampling> times,
                              MetadataTable& table) {
  std::vector<ogawa::Reference> children = {write_compound(builder, object.properties, table)};
  ByteWriter headers;
  for (const Object& child : object.children) {
    children.push_back(write_object(builder, child, times, table));
    headers.write_string(child.name);
    const std::uint8_t metadata = table.index(child.metadata);
    headers.write(metadata);
    if (metadata == k_inline_metadata) headers.write_string(child.metadata);
  }
  write_hash(headers, hash_properties(object.properties, times));
  write_hash(headers, hash_children(object, times));
  children.push_back(builder.data(headers.bytes()));
  return builder.group(children);
}

}  // namespace

Bytes emit(const Archive& archive, std::uint64_t base, ogawa::Reference& root) {
  ogawa::Builder builder(base);
  MetadataTable table;
  const std::int32_t layout_version = 0;
  ByteWriter samplings;
  for (const TimeSampling& t : archive.time_samplings) {
    samplings.write(t.max_samples).write(t.time_per_cycle).write(static_cast<std::uint32_t>(t.times.size()));
    samplings.write_array(std::span<const double>(t.times));
  }
  std::vector<ogawa::Reference> children;
  children.push_back(builder.data(std::as_bytes(std::span(&layout_version, 1))));
  children.push_back(builder.data(std::as_bytes(std::span(&k_library_version, 1))));
  children.push_back(write_object(builder, archive.top, archive.time_samplings, table));
  children.push_back(builder.data(bytes_of(archive.metadata)));
  children.push_back(builder.data(samplings.bytes()));
  children.push_back(builder.data(table.bytes()));
  root = builder.group(children);
  return builder.take();
}

}  // namespace ft::inline io::alembic

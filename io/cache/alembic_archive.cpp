// Trees of properties: see alembic_archive.h. The bytes are in alembic_emit.cpp and alembic_parse.cpp.
#include "io/cache/alembic_archive.h"

#include <algorithm>

namespace ft::inline io::alembic {

std::size_t pod_size(Pod pod) {
  switch (pod) {
    case Pod::k_bool:
    case Pod::k_u8:
    case Pod::k_i8: return 1;
    case Pod::k_u16:
    case Pod::k_i16:
    case Pod::k_f16: return 2;
    case Pod::k_u32:
    case Pod::k_i32:
    case Pod::k_f32: return 4;
    case Pod::k_u64:
    case Pod::k_i64:
    case Pod::k_f64: return 8;
    case Pod::k_string:
    case Pod::k_wstring: return 0;
  }
  return 0;
}

Bytes sample_payload(std::span<const std::byte> values) {
  if (values.empty()) return {};
  const Key key = murmur3(values);
  ByteWriter out;
  out.write(key.h1).write(key.h2).write_array(values);
  return out.take();
}

std::size_t Property::slot_of(std::uint32_t index) const {
  CHECK(!samples.empty());
  if (constant() || index < first_changed) return 0;
  const std::uint32_t slot = std::min(index, last_changed) - first_changed + 1;
  return std::min<std::size_t>(slot, samples.size() - 1);
}

const Property* Property::find(std::string_view child_name) const {
  for (const Property& child : children)
    if (child.name == child_name) return &child;
  return nullptr;
}

Property compound(std::string name, std::string metadata, std::vector<Property> children) {
  Property p;
  p.name = std::move(name);
  p.metadata = std::move(metadata);
  p.children = std::move(children);
  return p;
}

Property animated(PropertyKind kind, std::string name, std::string metadata, Pod pod, int extent,
                  std::uint32_t time_sampling, std::span<const Sample> all) {
  Property p;
  p.kind = kind;
  p.name = std::move(name);
  p.metadata = std::move(metadata);
  p.pod = pod;
  p.extent = extent;
  p.sample_count = static_cast<std::uint32_t>(all.size());
  p.time_sampling = time_sampling;
  for (std::uint32_t i = 1; i < p.sample_count; ++i) {
    if (p.first_changed == 0 && !all[i].same_values(all[0])) p.first_changed = i;
    if (!all[i].same_values(all[i - 1])) p.last_changed = i;
    if (all[i].size != all[0].size) p.homogeneous = false;
  }
  if (all.empty()) return p;
  p.samples.push_back(all[0]);
  if (!p.constant())
    for (std::uint32_t i = p.first_changed; i <= p.last_changed; ++i) p.samples.push_back(all[i]);
  const std::size_t element_size = pod_size(pod) * static_cast<std::size_t>(extent);
  p.single_element =
      kind == PropertyKind::k_array && p.homogeneous && element_size > 0 && all[0].size == 16 + element_size;
  return p;
}

Property constant(PropertyKind kind, std::string name, std::string metadata, Pod pod, int extent,
                  std::uint32_t time_sampling, const Sample& sample, std::uint32_t sample_count) {
  Property p = animated(kind, std::move(name), std::move(metadata), pod, extent, time_sampling, std::span(&sample, 1));
  p.sample_count = sample_count;
  return p;
}

namespace {

void feed(Hasher& hasher, const Property& p, std::span<const TimeSampling> time_samplings) {
  hasher.text(p.name).text(p.metadata).number(static_cast<std::uint8_t>(p.kind));
  if (p.kind != PropertyKind::k_compound) {
    hasher.number(static_cast<std::uint8_t>(p.pod)).number(p.extent).number(p.sample_count).number(p.first_changed);
    hasher.number(p.last_changed).number(p.time_sampling).number(std::uint8_t{p.homogeneous});
    hasher.number(std::uint8_t{p.single_element});
    if (p.time_sampling < time_samplings.size()) {
      const TimeSampling& t = time_samplings[p.time_sampling];
      hasher.number(t.time_per_cycle).bytes(t.times.data(), t.times.size() * sizeof(double));
    }
  }
  hasher.number(static_cast<std::uint64_t>(p.samples.size()));
  for (const Sample& s : p.samples) hasher.number(s.size).number(s.key.h1).number(s.key.h2);
  hasher.number(static_cast<std::uint64_t>(p.children.size()));
  for (const Property& child : p.children) feed(hasher, child, time_samplings);
}

}  // namespace

Hash128 hash_properties(std::span<const Property> properties, std::span<const TimeSampling> time_samplings) {
  Hasher hasher;
  for (const Property& p : properties) feed(hasher, p, time_samplings);
  return hasher.digest();
}

Hash128 hash_children(const Object& object, std::span<const TimeSampling> time_samplings) {
  if (object.children.empty()) return {};
  Hasher hasher;
  for (const Object& child : object.children) {
    const Hash128 properties = hash_properties(child.properties, time_samplings);
    const Hash128 children = hash_children(child, time_samplings);
    hasher.text(child.name).text(child.metadata).number(properties.low).number(properties.high);
    hasher.number(children.low).number(children.high);
  }
  return hasher.digest();
}

}  // namespace ft::inline io::alembic

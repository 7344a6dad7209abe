// An Alembic archive as a tree of objects and properties, and the two ways between tree and bytes: emit() writes all
// groups, headers and tables (the sample data stand in the file already), parse() reads them. Knows nothing of meshes:
// that is alembic_mesh. Careful: a property stores fewer samples than it has when some do not change; slot_of() maps
// one to the other.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/result.h"
#include "io/cache/murmur3.h"
#include "io/cache/ogawa.h"

namespace ft::inline io::alembic {

enum class Pod : std::uint8_t {
  k_bool,
  k_u8,
  k_i8,
  k_u16,
  k_i16,
  k_u32,
  k_i32,
  k_u64,
  k_i64,
  k_f16,
  k_f32,
  k_f64,
  k_string,
  k_wstring
};

/// Bytes per value; 0 for strings.
std::size_t pod_size(Pod pod);

/// One stored sample: 16 bytes of key, then raw values. Equal keys and sizes mean equal values.
struct Sample {
  ogawa::Reference data = ogawa::k_empty_data;
  ogawa::Reference dimensions = ogawa::k_empty_data;  ///< arrays of strings only
  std::uint64_t size = 0;                             ///< of the payload, key included [bytes]
  Key key;
  bool same_values(const Sample& other) const { return size == other.size && key == other.key; }
};

/// Payload of a data node: key, then values.
Bytes sample_payload(std::span<const std::byte> values);

enum class PropertyKind : std::uint8_t { k_compound, k_scalar, k_array };

struct Property {
  PropertyKind kind = PropertyKind::k_compound;
  std::string name;
  std::string metadata;  ///< "key=value;key=value", keys sorted
  // Scalars and arrays:
  Pod pod = Pod::k_f32;
  int extent = 1;                   ///< values per element: 3 for a point
  std::uint32_t sample_count = 0;   ///< as the user counts
  std::uint32_t first_changed = 0;  ///< first sample that differs from sample 0
  std::uint32_t last_changed = 0;   ///< last sample that differs from the one before
  std::uint32_t time_sampling = 0;  ///< index into Archive::time_samplings
  bool homogeneous = true;          ///< the same number of elements in every sample
  bool single_element = false;      ///< array of one element
  std::vector<Sample> samples;      ///< stored ones: sample 0, then first_changed .. last_changed
  // Compounds:
  std::vector<Property> children;

  bool constant() const { return last_changed == 0; }
  /// Index into samples of sample index (clamped); samples must not be empty.
  std::size_t slot_of(std::uint32_t index) const;
  const Property* find(std::string_view child_name) const;
};

Property compound(std::string name, std::string metadata, std::vector<Property> children);
/// From all samples in turn: finds what changes and keeps what must be stored.
Property animated(PropertyKind kind, std::string name, std::string metadata, Pod pod, int extent,
                  std::uint32_t time_sampling, std::span<const Sample> all);
/// The same sample sample_count times.
Property constant(PropertyKind kind, std::string name, std::string metadata, Pod pod, int extent,
                  std::uint32_t time_sampling, const Sample& sample, std::uint32_t sample_count);

struct Object {
  std::string name;
  std::string metadata;
  std::vector<Property> properties;
  std::vector<Object> children;
};

struct TimeSampling {
  std::uint32_t max_samples = 1;
  double time_per_cycle = 1;          ///< s
  std::vector<double> times = {0.0};  ///< within one cycle [s]
};

struct Archive {
  std::string metadata;
  std::vector<TimeSampling> time_samplings = {TimeSampling{}};  ///< the first is the identity
  Object top;
};

/// 128-bit hashes of content, as object headers carry them; the times of the samples are content too.
Hash128 hash_properties(std::span<const Property> properties, std::span<const TimeSampling> time_samplings);
Hash128 hash_children(const Object& object, std::span<const TimeSampling> time_samplings);

/// Everything but the sample data, for the place base in the file; root is where the header must point.
Bytes emit(const Archive& archive, std::uint64_t base, ogawa::Reference& root);

/// What an object says about its content. Every program hashes in its own way: only one's own files can be judged by
/// it.
struct StoredHashes {
  Hash128 properties, children;
};

/// Reads the tree and the key of every stored sample; every reference is inside the file afterwards. stored_hashes
/// receives the hashes of all objects, the top object first; root receives what the header points to.
Result<Archive> parse(const InputFile& file, std::vector<StoredHashes>* stored_hashes = nullptr,
                      ogawa::Reference* root = nullptr);

/// The raw values of a sample after a look at its key; an error when the file was damaged.
Result<Bytes> read_values(const InputFile& file, const Sample& sample);

}  // namespace ft::inline io::alembic

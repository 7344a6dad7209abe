// An output as an Alembic archive: one object whose properties are a list of entries, made once from the rest data.
// An entry is constant, or a channel that gets a sample a frame. ArchiveTree makes the archive for any number of
// frames, as a pure function of the samples so far. What stands in the list of each shape: alembic_mesh, _curves,
// _points.cpp.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "baker/core/give_back.h"
#include "io/cache/alembic_archive.h"
#include "io/cache/cache.h"

namespace ft::inline io::alembic {

/// What a frame may hold, in the order in which its data stand in the file.
enum Channel : std::uint8_t {
  k_positions,
  k_velocities,
  k_face_sizes,
  k_face_corners,
  k_ids,
  k_widths,
  k_orientations,
  k_angular_velocities,
  k_scales,
  k_scalars,  ///< the first of them, the others behind it
  k_bounds = k_scalars + 8,
  k_channel_count
};
inline constexpr std::size_t k_most_scalars = k_bounds - k_scalars;

/// The samples of the frames so far, one each per frame; a channel that the cache does not have is empty.
struct FrameSamples {
  std::array<std::vector<Sample>, k_channel_count> of;
  std::uint32_t count() const { return static_cast<std::uint32_t>(of[k_positions].size()); }
};

/// A property before its samples are known.
struct Entry {
  Property property;               ///< kind, name, metadata, type
  std::optional<Channel> channel;  ///< a sample a frame; none: `sample`, or a compound
  bool always = false;             ///< there without a frame, too; other channels come with their first sample
  bool shot_times = false;         ///< constant, but sampled as the frames are
  Sample sample;
  std::vector<Entry> children;
};

struct Layout {
  std::string schema;  ///< "AbcGeom_PolyMesh_v1"
  std::vector<Entry> geometry;
};

Entry channel_entry(Channel channel, std::string name, std::string metadata, Pod pod, int extent, bool always = false);
Entry constant_entry(std::string name, std::string metadata, Pod pod, int extent, const Sample& sample,
                     bool shot_times = false);
Entry compound_entry(std::string name, std::string metadata, std::vector<Entry> children);
/// Box and positions, with which every shape begins. scope: of the positions, "vtx" or "var".
std::vector<Entry> first_entries(std::string_view scope);
/// "arrayExtent=1;geoScope=...;interpretation=...;isGeomParam=true;podExtent=...;podName=..."
std::string parameter_metadata(std::string_view scope, std::string_view interpretation, int extent,
                               std::string_view pod);
/// Entries of scalars of vertices, a channel for each name.
void add_scalars(std::span<const std::string> names, std::vector<Entry>& to);
/// Entries of attributes; scopes: of one for all, for each, for each vertex.
void add_attributes(std::span<const CacheAttribute> attributes, std::array<std::string_view, 3> scopes,
                    ogawa::Builder& out, std::vector<Entry>& to);

/// Writes values that never change.
template <class T>
Sample append(ogawa::Builder& out, const std::vector<T>& values) {
  const auto raw = std::as_bytes(std::span(values));
  Sample s;
  s.data = out.data(sample_payload(raw));
  s.size = raw.empty() ? 0 : raw.size() + 16;
  if (!raw.empty()) s.key = murmur3(raw);
  return s;
}
Sample append_strings(ogawa::Builder& out, const std::vector<std::string>& values);
std::vector<float> flat(std::span<const Vec3> points);

Layout mesh_layout(const CacheInfo& info, ogawa::Builder& out);
Layout curves_layout(const CacheInfo& info, ogawa::Builder& out);
Layout points_layout(const CacheInfo& info, ogawa::Builder& out);
Layout instances_layout(const CacheInfo& info, ogawa::Builder& out);

class ArchiveTree {
 public:
  explicit ArchiveTree(const CacheInfo& info);

  /// Data of all that never changes; stands in the file from offset k_header_size on.
  const Bytes& static_bytes() const { return static_bytes_; }
  /// Frees them, once they are in the file.
  void forget_static_bytes() { give_back(static_bytes_); }
  /// The archive after the first count frames.
  Archive archive(const FrameSamples& frames, std::uint32_t count) const;
  /// More than any tail of at most capacity frames takes [bytes], in whole sectors.
  std::uint64_t tail_bound(std::uint32_t capacity) const;
  /// Where a file of this layout has each of its channels; null where it has not. The archive has to stay.
  std::array<const Property*, k_channel_count> channels_in(const Archive& archive) const;

 private:
  std::string system_;
  double fps_;
  int first_frame_;
  Layout layout_;
  Bytes static_bytes_;
};

/// True when the archive says that this program wrote it: its hashes can then be checked.
bool is_own(const Archive& archive);

}  // namespace ft::inline io::alembic

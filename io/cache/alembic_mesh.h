// A cache as an Alembic archive: one PolyMesh with positions, velocities, bounds, UVs, rest positions and provenance.
// MeshTree holds what never changes and makes the archive for any number of frames, as a pure function of the samples
// so far; MeshView finds the same things in any archive. Careful: Alembic winds faces clockwise seen from outside
// (RenderMan), our meshes counter-clockwise.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/give_back.h"
#include "io/cache/alembic_archive.h"
#include "io/cache/alembic_transform.h"
#include "io/cache/cache.h"

namespace ft::alembic {

/// The samples of the frames so far, one each per frame; velocities is empty when the cache has none.
struct FrameSamples {
  std::vector<Sample> positions, velocities, bounds;
  std::uint32_t count() const { return static_cast<std::uint32_t>(positions.size()); }
};

/// Corners of every face in reverse order; applied twice it changes nothing.
void reverse_faces(std::span<const int> face_sizes, std::vector<int>& corners);

class MeshTree {
 public:
  explicit MeshTree(const CacheInfo& info);

  /// Data of all that never changes; stands in the file from offset k_header_size on.
  const Bytes& static_bytes() const { return static_bytes_; }
  /// Frees them, once they are in the file.
  void forget_static_bytes() { give_back(static_bytes_); }
  /// The archive after the first count frames.
  Archive archive(const FrameSamples& frames, std::uint32_t count) const;
  /// More than any tail of at most capacity frames takes [bytes], in whole sectors.
  std::uint64_t tail_bound(std::uint32_t capacity) const;

 private:
  std::string system_;
  double fps_;
  int first_frame_;
  std::vector<std::pair<std::string, Sample>> provenance_;
  Sample face_indices_, face_sizes_, uv_values_, uv_indices_, rest_;
  bool has_uvs_ = false;
  Bytes static_bytes_;
};

/// True when the archive says that this program wrote it: its hashes can then be checked.
bool is_own(const Archive& archive);

/// What a reader needs, found in an archive of any origin: the first PolyMesh of constant topology.
struct MeshView {
  CacheInfo info;  ///< mesh.positions: the first frame, or the rest positions of a cache without frames, in the world
  Property positions;
  Property velocities;        ///< no samples where there are none
  TransformChain transforms;  ///< of the objects around the mesh
  TimeSampling times;         ///< of positions
};
Result<MeshView> find_mesh(const InputFile& file, const Archive& archive);

}  // namespace ft::alembic

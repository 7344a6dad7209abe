#include "baker/record/cached_instances.h"

#include <fmt/format.h>

#include <algorithm>

namespace ft::inline baker {
namespace {

/// One mesh of all prototypes, back into them.
std::vector<Mesh> split(const Mesh& all, std::span<const ManifestPrototype> prototypes) {
  std::vector<Mesh> out;
  std::size_t vertex = 0, face = 0, corner = 0;
  for (const ManifestPrototype& p : prototypes) {
    Mesh& mesh = out.emplace_back();
    mesh.name = p.name;
    const auto first = all.positions.begin() + static_cast<std::ptrdiff_t>(vertex);
    mesh.positions.assign(first, first + p.vertex_count);
    for (int f = 0; f < p.face_count; ++f, ++face) {
      mesh.face_sizes.push_back(all.face_sizes[face]);
      for (int k = 0; k < all.face_sizes[face]; ++k, ++corner)
        mesh.face_vertices.push_back(all.face_vertices[corner] - static_cast<int>(vertex));
    }
    vertex += at(p.vertex_count);
  }
  return out;
}

/// What is wrong with the instances of a cache; empty: they are those of the manifest.
std::string fault_of_instances(const InstanceSet& set, const ManifestSystem& system) {
  if (set.ids.size() != at(system.count))
    return fmt::format("has {} instances, the manifest says {}", set.ids.size(), system.count);
  std::vector<std::uint64_t> ids = set.ids;
  std::sort(ids.begin(), ids.end());
  if (const auto twin = std::adjacent_find(ids.begin(), ids.end()); twin != ids.end())
    return fmt::format("has the id {} twice", *twin);
  const auto same = [](const std::string& name, const ManifestPrototype& p) { return name == p.name; };
  if (!std::equal(set.prototype_names.begin(), set.prototype_names.end(), system.prototypes.begin(),
                  system.prototypes.end(), same))
    return "has other prototypes than the manifest says";
  return {};
}

/// What is wrong with the file of the prototypes; empty: it has those of the manifest.
std::string fault_of_prototypes(const Mesh& all, std::span<const ManifestPrototype> prototypes) {
  std::int64_t vertices = 0, faces = 0;
  std::size_t face = 0, corner = 0;
  for (const ManifestPrototype& p : prototypes) {
    if (p.vertex_count < 0 || p.face_count < 0) return "has prototypes of a negative size, the manifest says";
    const std::int64_t first = vertices;
    vertices += p.vertex_count;
    faces += p.face_count;
    if (vertices > all.vertex_count() || faces > all.face_count()) break;
    for (; face < static_cast<std::size_t>(faces); ++face)
      for (int k = 0; k < all.face_sizes[face]; ++k, ++corner)
        if (all.face_vertices[corner] < first || all.face_vertices[corner] >= vertices)
          return "has faces between prototypes";
  }
  if (vertices == all.vertex_count() && faces == all.face_count()) return {};
  return fmt::format("has {} vertices and {} faces, the prototypes of the manifest have {} and {}", all.vertex_count(),
                     all.face_count(), vertices, faces);
}

}  // namespace

Status add_instances(const std::filesystem::path& folder, const ManifestSystem& system, CacheTrack& track) {
  if (std::string fault = fault_of_instances(track.reader->info().instances, system); !fault.empty())
    return input_error(std::move(fault), (folder / system.caches[0].file).string());
  if (std::string fault = fault_of_prototypes(track.rest, system.prototypes); !fault.empty())
    return input_error(std::move(fault), (folder / system.topology).string());
  track.prototypes = split(track.rest, system.prototypes);
  return {};
}

}  // namespace ft::inline baker

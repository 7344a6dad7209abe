#include "baker/run/cached_shape.h"

#include "io/shot/mesh_file.h"

namespace ft::inline baker {

void describe_shape(const SystemShape& shape, ManifestSystem& system) {
  system.shape = shape.content.shape;
  system.count = shape.element_count();
  system.curve_count = shape.curves.curve_count();
  for (std::size_t i = 0; i < shape.prototypes.size(); ++i) {
    const Mesh& mesh = shape.prototypes[i];
    system.prototypes.push_back({shape.instances.prototype_names[i], mesh.vertex_count(), mesh.face_count()});
  }
  if (!shape.prototypes.empty()) system.topology = system.name + ".obj";
}

void fill_info(const SystemShape& shape, CacheInfo& info) {
  info.content = shape.content;
  info.curves = shape.curves;
  info.instances = shape.instances;
  info.attributes = shape.attributes;
}

Status write_prototypes(const std::filesystem::path& path, const SystemShape& shape) {
  if (shape.prototypes.empty()) return {};
  std::vector<Mesh> named = shape.prototypes;
  for (std::size_t i = 0; i < named.size(); ++i) named[i].name = shape.instances.prototype_names[i];
  return write_obj(path, joined_meshes(shape.name, named));
}

}  // namespace ft::inline baker

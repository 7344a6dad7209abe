// Points and instances in an archive, by AbcGeom's Points schema, version 1. Alembic has no schema of instances that
// programs agree on: they are points whose arbitrary parameters have the names that copy-to-points tools look for:
// orient (x y z w), w (angular velocity), scale. The prototypes are an index for each and a list of names for all.
// Careful: orient has no interpretation "quat", for the order of that one is w x y z.
#include "io/cache/alembic_tree.h"

namespace ft::inline io::alembic {

Layout points_layout(const CacheInfo& info, ogawa::Builder&) {
  Layout layout{"AbcGeom_Points_v1", first_entries("var")};
  std::vector<Entry>& geometry = layout.geometry;
  geometry.push_back(channel_entry(k_ids, ".pointIds", "geoScope=var", Pod::k_u64, 1, true));
  if (info.content.velocities)
    geometry.push_back(channel_entry(k_velocities, ".velocities", "interpretation=vector", Pod::k_f32, 3));
  if (info.content.widths)
    geometry.push_back(
        channel_entry(k_widths, ".widths", parameter_metadata("var", "", 1, "float32_t"), Pod::k_f32, 1));
  return layout;
}

Layout instances_layout(const CacheInfo& info, ogawa::Builder& out) {
  Layout layout{"AbcGeom_Points_v1", first_entries("var")};
  std::vector<Entry>& geometry = layout.geometry;
  const InstanceSet& set = info.instances;
  geometry.push_back(constant_entry(".pointIds", "geoScope=var", Pod::k_u64, 1, append(out, set.ids), true));
  if (info.content.velocities)
    geometry.push_back(channel_entry(k_velocities, ".velocities", "interpretation=vector", Pod::k_f32, 3));
  const std::string vectors = parameter_metadata("var", "vector", 3, "float32_t");
  std::vector<Entry> parameters;
  parameters.push_back(
      channel_entry(k_orientations, "orient", parameter_metadata("var", "", 4, "float32_t"), Pod::k_f32, 4, true));
  if (info.content.angular_velocities)
    parameters.push_back(channel_entry(k_angular_velocities, "w", vectors, Pod::k_f32, 3));
  if (info.content.scales) parameters.push_back(channel_entry(k_scales, "scale", vectors, Pod::k_f32, 3));
  parameters.push_back(constant_entry("protoIndices", parameter_metadata("var", "", 1, "int32_t"), Pod::k_i32, 1,
                                      append(out, set.prototypes)));
  parameters.push_back(constant_entry("prototypes", parameter_metadata("con", "", 1, "string"), Pod::k_string, 1,
                                      append_strings(out, set.prototype_names)));
  add_attributes(info.attributes, {"con", "var", "var"}, out, parameters);
  geometry.push_back(compound_entry(".arbGeomParams", "", std::move(parameters)));
  return layout;
}

}  // namespace ft::inline io::alembic

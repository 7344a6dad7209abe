// Curves in an archive, by AbcGeom's Curves schema, version 2: linear, open. Importers of hair read the attributes from
// the arbitrary parameters; what their names mean is for whoever fills them in. Careful: Blender takes any width but a
// single one as a width for each vertex and does not look at the scope, so that a width for each curve is written for
// each of its vertices.
#include "io/cache/alembic_tree.h"

namespace ft::inline io::alembic {
namespace {

std::vector<float> spread_over_vertices(const CurveSet& curves) {
  if (curves.widths.size() != curves.vertices_per_curve.size() || curves.widths.size() <= 1) return curves.widths;
  std::vector<float> out;
  for (std::size_t c = 0; c < curves.widths.size(); ++c)
    out.insert(out.end(), at(curves.vertices_per_curve[c]), curves.widths[c]);
  return out;
}

}  // namespace

Layout curves_layout(const CacheInfo& info, ogawa::Builder& out) {
  Layout layout{"AbcGeom_Curve_v2", first_entries("vtx")};
  std::vector<Entry>& geometry = layout.geometry;
  const CurveSet& curves = info.curves;
  geometry.push_back(constant_entry("nVertices", "", Pod::k_i32, 1, append(out, curves.vertices_per_curve), true));
  const std::vector<std::uint8_t> linear_open = {1, 0, 0, 0};  // type, wrap, basis, basis
  geometry.push_back(constant_entry("curveBasisAndType", "", Pod::k_u8, 4, append(out, linear_open), true));
  geometry.back().property.kind = PropertyKind::k_scalar;
  if (!curves.widths.empty()) {
    const std::string metadata = parameter_metadata(curves.widths.size() == 1 ? "con" : "vtx", "", 1, "float32_t");
    const Sample widths = append(out, spread_over_vertices(curves));
    geometry.push_back(constant_entry("width", metadata, Pod::k_f32, 1, widths));
  }
  if (info.content.velocities)
    geometry.push_back(channel_entry(k_velocities, ".velocities", "interpretation=vector", Pod::k_f32, 3));
  std::vector<Entry> parameters;
  parameters.push_back(constant_entry("Pref", parameter_metadata("vtx", "point", 3, "float32_t"), Pod::k_f32, 3,
                                      append(out, flat(curves.rest))));
  if (!curves.ids.empty()) {
    const std::vector<std::int32_t> ids(curves.ids.begin(), curves.ids.end());
    parameters.push_back(
        constant_entry("id", parameter_metadata("uni", "", 1, "int32_t"), Pod::k_i32, 1, append(out, ids)));
  }
  add_attributes(info.attributes, {"con", "uni", "vtx"}, out, parameters);
  geometry.push_back(compound_entry(".arbGeomParams", "", std::move(parameters)));
  return layout;
}

}  // namespace ft::inline io::alembic

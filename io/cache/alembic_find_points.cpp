// Archive to cache: curves, points and instances.
#include <algorithm>
#include <cmath>
#include <utility>

#include "io/cache/alembic_view.h"

namespace ft::inline io::alembic {
namespace {

/// Attributes of the kinds that we write, constant ones, of any of the counts that go with a scope.
Status read_attributes(const InputFile& file, const Property& parameters, std::span<const std::string_view> known,
                       std::array<std::string_view, 3> scopes, CacheInfo& info) {
  for (const Property& p : parameters.children) {
    if (p.kind != PropertyKind::k_array || p.samples.empty() || !p.constant()) continue;
    if (std::find(known.begin(), known.end(), p.name) != known.end()) continue;
    CacheAttribute a;
    a.name = p.name;
    std::size_t scope = 0;
    while (scope < 3 && p.metadata.find("geoScope=" + std::string(scopes[scope])) == std::string::npos) ++scope;
    if (scope == 3) continue;
    a.scope = static_cast<AttributeScope>(scope);
    Error error;
    const auto take = [&](auto values) {
      if (!values) return error = values.error(), false;
      a.values = std::move(*values);
      return true;
    };
    const Sample& s = p.samples.front();
    bool good = false;
    if (p.pod == Pod::k_i16 && p.extent == 1)
      good = take(values_of<std::int16_t>(file, s));
    else if (p.pod == Pod::k_i32 && p.extent == 1)
      good = take(values_of<std::int32_t>(file, s));
    else if (p.pod == Pod::k_f32 && p.extent == 1)
      good = take(values_of<float>(file, s));
    else if (p.pod == Pod::k_f32 && p.extent == 2)
      good = take(values_of<Eigen::Vector2f>(file, s));
    else if (p.pod == Pod::k_string && p.extent == 1)
      good = take(strings_of(file, s));
    else
      continue;
    if (!good) return error;
    info.attributes.push_back(std::move(a));
  }
  return {};
}

Error damaged(const InputFile& file, std::string what) {
  return input_error("is damaged: " + std::move(what), file.path().string());
}

bool all_widths(std::span<const float> widths) {
  return std::all_of(widths.begin(), widths.end(), [](float w) { return std::isfinite(w) && w >= 0; });
}

}  // namespace

Status view_curves(const InputFile& file, const Property& geom, ShapeView& view) {
  CacheInfo& info = view.info;
  CurveSet& curves = info.curves;
  const Property* counts = geom.find("nVertices");
  if (!is_array(counts, Pod::k_i32, 1)) return damaged(file, "curves without numbers of vertices");
  if (!counts->constant() || info.content.changes)
    return input_error("has curves whose number or vertices change", file.path().string());
  auto read = values_of<int>(file, counts->samples.front());
  if (!read) return read.error();
  std::uint64_t total = 0;
  for (const int n : *read) {
    if (n < 1) return damaged(file, "a curve with " + std::to_string(n) + " vertices");
    total += static_cast<std::uint64_t>(n);
  }
  if (total != static_cast<std::uint64_t>(info.vertex_count)) return damaged(file, "numbers of vertices do not add up");
  curves.vertices_per_curve = std::move(*read);
  curves.rest = std::exchange(info.mesh.positions, {});
  const Property* widths = geom.find("width");
  if (is_array(widths, Pod::k_f32, 1) && widths->constant()) {
    auto values = values_of<float>(file, widths->samples.front());
    if (!values) return values.error();
    if (!all_widths(*values)) return damaged(file, "widths that make no sense");
    const std::size_t n = values->size();
    if (n == 1 || n == curves.rest.size() || n == curves.vertices_per_curve.size()) curves.widths = std::move(*values);
  }
  const Property* parameters = geom.find(".arbGeomParams");
  if (parameters == nullptr) return {};
  const Property* rest = parameters->find("Pref");
  if (is_array(rest, Pod::k_f32, 3)) {
    const auto values = values_of<Vec3f>(file, rest->samples.front());
    if (!values) return values.error();
    if (values.value().size() != curves.rest.size()) return damaged(file, "rest positions do not match positions");
    for (std::size_t i = 0; i < curves.rest.size(); ++i) {
      if (!values.value()[i].allFinite()) return damaged(file, "rest positions that are not finite");
      curves.rest[i] = values.value()[i].cast<double>();
    }
  }
  const Property* ids = parameters->find("id");
  if (is_array(ids, Pod::k_i32, 1) && ids->constant()) {
    const auto values = values_of<std::int32_t>(file, ids->samples.front());
    if (!values) return values.error();
    if (values.value().size() == curves.vertices_per_curve.size())
      for (const std::int32_t id : values.value()) curves.ids.push_back(static_cast<std::uint32_t>(id));
  }
  return read_attributes(file, *parameters, std::array<std::string_view, 2>{"Pref", "id"}, {"con", "uni", "vtx"}, info);
}

Status view_points(const InputFile& file, const Property& geom, ShapeView& view) {
  CacheInfo& info = view.info;
  info.mesh = {};
  const Property *ids = geom.find(".pointIds"), *parameters = geom.find(".arbGeomParams");
  const Property* turns = parameters == nullptr ? nullptr : parameters->find("orient");
  const bool instances = turns != nullptr && turns->kind == PropertyKind::k_array && turns->pod == Pod::k_f32 &&
                         turns->extent == 4 && turns->sample_count == view.channels[k_positions].sample_count &&
                         is_array(ids, Pod::k_u64, 1) && ids->constant() && !info.content.changes;
  if (!instances) {
    info.content.changes = true;
    adopt_channel(view, k_ids, ids, Pod::k_u64, 1);
    info.content.widths = adopt_channel(view, k_widths, geom.find(".widths"), Pod::k_f32, 1);
    return {};
  }
  if (!view.transforms.identity()) return input_error("has instances under a transform", file.path().string());
  info.content.shape = OutputShape::k_instances;
  view.channels[k_orientations] = *turns;
  info.content.angular_velocities = adopt_channel(view, k_angular_velocities, parameters->find("w"), Pod::k_f32, 3);
  info.content.scales = adopt_channel(view, k_scales, parameters->find("scale"), Pod::k_f32, 3);
  auto numbers = values_of<std::uint64_t>(file, ids->samples.front());
  if (!numbers) return numbers.error();
  if (info.frame_count > 0 && numbers->size() != static_cast<std::size_t>(info.vertex_count))
    return damaged(file, "ids do not match positions");
  info.vertex_count = static_cast<int>(numbers->size());
  InstanceSet& set = info.instances;
  set.ids = std::move(*numbers);
  set.prototypes.assign(set.ids.size(), 0);
  const Property *indices = parameters->find("protoIndices"), *names = parameters->find("prototypes");
  if (is_array(indices, Pod::k_i32, 1) && is_array(names, Pod::k_string, 1)) {
    auto read = values_of<int>(file, indices->samples.front());
    if (!read) return read.error();
    auto texts = strings_of(file, names->samples.front());
    if (!texts) return texts.error();
    if (read->size() != set.ids.size()) return damaged(file, "prototypes do not match instances");
    for (const int p : *read)
      if (p < 0 || at(p) >= texts->size()) return damaged(file, "there is no prototype " + std::to_string(p));
    set.prototypes = std::move(*read);
    set.prototype_names = std::move(*texts);
  }
  return read_attributes(file, *parameters,
                         std::array<std::string_view, 5>{"orient", "w", "scale", "protoIndices", "prototypes"},
                         {"con", "var", "vtx"}, info);
}

}  // namespace ft::inline io::alembic

// Archive to cache: the first output in an archive of any origin, and what all shapes have: positions, velocities,
// times, transforms, provenance.
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/cache/alembic_view.h"

namespace ft::inline io::alembic {
namespace {

struct Found {
  const Object* object = nullptr;
  std::vector<Property> transforms;
};

const Property* property_of(const Object& object, std::string_view name) {
  for (const Property& p : object.properties)
    if (p.name == name) return &p;
  return nullptr;
}

bool find_first(const Object& object, std::string_view schema, Found& found) {
  if (object.metadata.find(schema) != std::string::npos && property_of(object, ".geom") != nullptr) {
    found.object = &object;
    return true;
  }
  const Property* transform = property_of(object, ".xform");
  if (transform != nullptr) found.transforms.push_back(*transform);
  for (const Object& child : object.children)
    if (find_first(child, schema, found)) return true;
  if (transform != nullptr) found.transforms.pop_back();
  return false;
}

/// Number of elements of a sample.
std::uint64_t element_count(const Property& p, const Sample& s) {
  const std::uint64_t element = pod_size(p.pod) * static_cast<std::uint64_t>(p.extent);
  return s.size < 16 || element == 0 ? 0 : (s.size - 16) / element;
}

struct Schema {
  std::string_view name;
  OutputShape shape;
  Status (*view)(const InputFile&, const Property&, ShapeView&);
};
constexpr Schema k_schemas[] = {{"schema=AbcGeom_PolyMesh_v1", OutputShape::k_mesh, view_mesh},
                                {"schema=AbcGeom_Curve_v2", OutputShape::k_curves, view_curves},
                                {"schema=AbcGeom_Points_v1", OutputShape::k_points, view_points}};

class Reader {
 public:
  Reader(const InputFile& file, const Archive& archive) : file_(file), archive_(archive) {}

  Result<ShapeView> run() {
    Found found;
    const Schema* schema = std::begin(k_schemas);
    while (schema != std::end(k_schemas) && !find_first(archive_.top, schema->name, found)) ++schema;
    if (schema == std::end(k_schemas)) return fault("holds no polygon mesh, no curves and no points");
    const Property& geom = *property_of(*found.object, ".geom");
    view_.info.system = found.object->name;
    view_.info.content = {.shape = schema->shape, .velocities = false};
    auto transforms = TransformChain::read(file_, archive_, found.transforms);
    if (!transforms) return transforms.error();
    view_.transforms = std::move(*transforms);
    Status status = read_animation(geom);
    if (status) status = schema->view(file_, geom, view_);
    if (status) status = read_provenance(geom);
    if (!status) return status.error();
    read_times();
    const Eigen::Affine3d to_world = view_.transforms.at(sample_time(view_.times, 0));
    if (!view_.transforms.identity())
      for (std::vector<Vec3>* points : {&view_.info.mesh.positions, &view_.info.curves.rest})
        for (Vec3& p : *points) p = to_world * p;
    return std::move(view_);
  }

 private:
  Error fault(std::string what) const { return input_error(std::move(what), file_.path().string()); }

  Status read_animation(const Property& geom) {
    const Property* p = geom.find("P");
    if (p == nullptr || p->kind != PropertyKind::k_array || p->pod != Pod::k_f32 || p->extent != 3)
      return fault("has " + std::string(shape_name(view_.info.content.shape)) + " without positions");
    if (p->sample_count > std::numeric_limits<int>::max()) return fault("is damaged: too many frames");
    view_.channels[k_positions] = *p;
    view_.info.frame_count = static_cast<int>(p->sample_count);
    const Property* params = geom.find(".arbGeomParams");
    const Property* rest = params == nullptr ? nullptr : params->find("Pref");
    const bool has_rest = is_array(rest, Pod::k_f32, 3);
    const Property* first = p->samples.empty() ? (has_rest ? rest : nullptr) : p;
    if (first == nullptr) return {};
    const Sample& sample = first->samples.front();
    const std::uint64_t count = element_count(*first, sample);
    if (count > std::numeric_limits<int>::max() || (sample.size > 0 && sample.size != 16 + 12 * count))
      return fault("is damaged: a part of a position");
    view_.info.vertex_count = static_cast<int>(count);
    for (const Sample& s : p->samples)
      if (s.size != sample.size) view_.info.content.changes = true;
    const auto values = values_of<float>(file_, sample);
    if (!values) return values.error();
    for (std::size_t i = 0; i + 2 < values.value().size(); i += 3) {
      const Vec3 point(values.value()[i], values.value()[i + 1], values.value()[i + 2]);
      if (!point.allFinite()) return fault("is damaged: positions that are not finite");
      view_.info.mesh.positions.push_back(point);
    }
    const Property* v = geom.find(".velocities");
    // Under animated transforms the velocities of the file leave out how the transforms move.
    if (!view_.transforms.constant() || !adopt_channel(view_, k_velocities, v, Pod::k_f32, 3)) return {};
    if (!view_.info.content.changes)
      for (const Sample& s : v->samples)
        if (s.size != sample.size) return fault("is damaged: velocities do not match positions");
    view_.info.has_velocity = view_.info.content.velocities = true;
    return {};
  }

  Status read_provenance(const Property& geom) {
    const Property* user = geom.find(".userProperties");
    if (user == nullptr) return {};
    for (const Property& p : user->children) {
      if (p.kind != PropertyKind::k_scalar || p.pod != Pod::k_string || p.samples.empty()) continue;
      const auto text = values_of<char>(file_, p.samples.front());
      if (!text) return text.error();
      const auto& characters = text.value();
      view_.info.metadata.emplace_back(
          p.name, std::string(characters.begin(), std::find(characters.begin(), characters.end(), '\0')));
    }
    std::sort(view_.info.metadata.begin(), view_.info.metadata.end());
    return {};
  }

  void read_times() {
    const TimeSampling& t = view_.times = archive_.time_samplings[view_.channels[k_positions].time_sampling];
    double step = t.time_per_cycle / static_cast<double>(t.times.size());
    if (t.times.size() > 1)
      step = t.times[1] - t.times[0];  // unevenly spaced times have no frame rate; this is the best guess
    view_.info.has_fps = t.times.size() == 1 && view_.channels[k_positions].time_sampling != 0;
    double fps = step > 0 ? 1 / step : 24;
    for (const double rate : {std::round(fps), std::round(fps * 1.001) / 1.001})  // undo the rounding of 1/fps
      if (rate > 0 && std::abs(rate - fps) < 1e-12 * fps) fps = rate;
    view_.info.fps = fps;
    const double frame = std::round(t.times.front() * fps);
    view_.info.first_frame = std::abs(frame) < 1e9 ? static_cast<int>(frame) : 0;
  }

  const InputFile& file_;
  const Archive& archive_;
  ShapeView view_;
};

}  // namespace

bool is_array(const Property* p, Pod pod, int extent) {
  return p != nullptr && p->kind == PropertyKind::k_array && p->pod == pod && p->extent == extent &&
         !p->samples.empty();
}

bool adopt_channel(ShapeView& view, Channel channel, const Property* p, Pod pod, int extent) {
  if (!is_array(p, pod, extent) || p->sample_count != view.channels[k_positions].sample_count) return false;
  view.channels[channel] = *p;
  return true;
}

Result<std::vector<std::string>> strings_of(const InputFile& file, const Sample& sample) {
  const auto text = values_of<char>(file, sample);
  if (!text) return text.error();
  std::vector<std::string> out;
  std::string one;
  for (const char c : text.value())
    if (c == '\0')
      out.push_back(std::exchange(one, {}));
    else
      one.push_back(c);
  return out;
}

Result<ShapeView> find_shape(const InputFile& file, const Archive& archive) {
  return Reader(file, archive).run();
}

}  // namespace ft::inline io::alembic

// Archive to cache: the first PolyMesh of an archive of any origin, checked so that nothing in it can be out of range
// later.
#include <algorithm>
#include <cmath>
#include <limits>

#include "io/cache/alembic_mesh.h"

namespace ft::alembic {
namespace {

struct Found {
  const Object* mesh = nullptr;
  std::vector<Property> transforms;
};

const Property* property_of(const Object& object, std::string_view name) {
  for (const Property& p : object.properties)
    if (p.name == name) return &p;
  return nullptr;
}

bool find_first(const Object& object, Found& found) {
  const bool mesh = object.metadata.find("schema=AbcGeom_PolyMesh_v1") != std::string::npos &&
                    property_of(object, ".geom") != nullptr;
  if (mesh) {
    found.mesh = &object;
    return true;
  }
  const Property* transform = property_of(object, ".xform");
  if (transform != nullptr) found.transforms.push_back(*transform);
  for (const Object& child : object.children)
    if (find_first(child, found)) return true;
  if (transform != nullptr) found.transforms.pop_back();
  return false;
}

/// Number of elements of a sample.
std::uint64_t element_count(const Property& p, const Sample& s) {
  const std::uint64_t element = pod_size(p.pod) * static_cast<std::uint64_t>(p.extent);
  return s.size < 16 || element == 0 ? 0 : (s.size - 16) / element;
}

bool is_array(const Property* p, Pod pod, int extent) {
  return p != nullptr && p->kind == PropertyKind::k_array && p->pod == pod && p->extent == extent &&
         !p->samples.empty();
}

template <class T>
Result<std::vector<T>> values_of(const InputFile& file, const Sample& sample) {
  const auto raw = read_values(file, sample);
  if (!raw) return raw.error();
  ByteReader in(raw.value());
  return in.read_array<T>(raw.value().size() / sizeof(T));
}

class Reader {
 public:
  Reader(const InputFile& file, const Archive& archive) : file_(file), archive_(archive) {}

  Result<MeshView> run() {
    Found found;
    if (!find_first(archive_.top, found)) return fault("holds no polygon mesh");
    const Property& geom = *property_of(*found.mesh, ".geom");
    view_.info.system = found.mesh->name;
    auto transforms = TransformChain::read(file_, archive_, found.transforms);
    if (!transforms) return transforms.error();
    view_.transforms = std::move(*transforms);
    Status status = read_animation(geom);
    if (status) status = read_topology(geom);
    if (status) status = read_uvs(geom);
    if (status) status = read_provenance(geom);
    if (!status) return status.error();
    read_times();
    const Eigen::Affine3d to_world = view_.transforms.at(sample_time(view_.times, 0));
    if (!view_.transforms.identity())
      for (Vec3& p : view_.info.mesh.positions) p = to_world * p;
    return std::move(view_);
  }

 private:
  Error fault(std::string what) const { return input_error(std::move(what), file_.path().string()); }

  Status read_animation(const Property& geom) {
    const Property* p = geom.find("P");
    if (p == nullptr || p->kind != PropertyKind::k_array || p->pod != Pod::k_f32 || p->extent != 3)
      return fault("has a mesh without positions");
    if (p->sample_count > std::numeric_limits<int>::max()) return fault("is damaged: too many frames");
    view_.positions = *p;
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
      if (s.size != sample.size) return fault("has a mesh whose topology changes");
    const auto values = values_of<float>(file_, sample);
    if (!values) return values.error();
    for (std::size_t i = 0; i + 2 < values.value().size(); i += 3) {
      const Vec3 point(values.value()[i], values.value()[i + 1], values.value()[i + 2]);
      if (!point.allFinite()) return fault("is damaged: positions that are not finite");
      view_.info.mesh.positions.push_back(point);
    }
    const Property* v = geom.find(".velocities");
    // Under animated transforms the velocities of the file leave out how the transforms move.
    if (!is_array(v, Pod::k_f32, 3) || v->sample_count != p->sample_count || !view_.transforms.constant()) return {};
    for (const Sample& s : v->samples)
      if (s.size != sample.size) return fault("is damaged: velocities do not match positions");
    view_.velocities = *v;
    view_.info.has_velocity = true;
    return {};
  }

  Status read_topology(const Property& geom) {
    const Property* sizes = geom.find(".faceCounts");
    const Property* corners = geom.find(".faceIndices");
    if (!is_array(sizes, Pod::k_i32, 1) || !is_array(corners, Pod::k_i32, 1)) return fault("has a mesh without faces");
    if (!sizes->constant() || !corners->constant()) return fault("has a mesh whose topology changes");
    auto face_sizes = values_of<int>(file_, sizes->samples.front());
    if (!face_sizes) return face_sizes.error();
    auto face_vertices = values_of<int>(file_, corners->samples.front());
    if (!face_vertices) return face_vertices.error();
    std::uint64_t total = 0;
    for (const int n : *face_sizes) {
      if (n < 3) return fault("has a face with " + std::to_string(n) + " corners");
      total += static_cast<std::uint64_t>(n);
    }
    if (total != face_vertices->size()) return fault("is damaged: face sizes do not add up");
    for (const int v : *face_vertices)
      if (v < 0 || v >= view_.info.vertex_count) return fault("is damaged: a face uses vertex " + std::to_string(v));
    Mesh& mesh = view_.info.mesh;
    mesh.name = view_.info.system;
    mesh.face_sizes = std::move(*face_sizes);
    mesh.face_vertices = std::move(*face_vertices);
    reverse_faces(mesh.face_sizes, mesh.face_vertices);
    return {};
  }

  /// UVs per corner or per vertex, indexed or not; others are left out.
  Status read_uvs(const Property& geom) {
    const Property* uv = geom.find("uv");
    if (uv == nullptr) return {};
    const bool indexed = uv->kind == PropertyKind::k_compound;
    const Property* values = indexed ? uv->find(".vals") : uv;
    const Property* indices = indexed ? uv->find(".indices") : nullptr;
    if (!is_array(values, Pod::k_f32, 2) || (indexed && !is_array(indices, Pod::k_u32, 1))) return {};
    const auto floats = values_of<float>(file_, values->samples.front());
    if (!floats) return floats.error();
    std::vector<int> corners;
    if (indexed) {
      auto read = values_of<int>(file_, indices->samples.front());
      if (!read) return read.error();
      corners = std::move(*read);
    } else {
      for (std::size_t i = 0; i < floats.value().size() / 2; ++i) corners.push_back(static_cast<int>(i));
    }
    Mesh& mesh = view_.info.mesh;
    if (corners.size() == mesh.face_vertices.size()) {
      reverse_faces(mesh.face_sizes, corners);
    } else if (corners.size() == static_cast<std::size_t>(view_.info.vertex_count)) {
      std::vector<int> of_vertex = std::exchange(corners, {});
      for (const int v : mesh.face_vertices) corners.push_back(of_vertex[static_cast<std::size_t>(v)]);
    } else {
      return {};
    }
    for (const int i : corners)
      if (i < 0 || static_cast<std::size_t>(i) >= floats.value().size() / 2)
        return fault("is damaged: a face uses a missing uv");
    for (std::size_t i = 0; i + 1 < floats.value().size(); i += 2) {
      const Vec2 value(floats.value()[i], floats.value()[i + 1]);
      if (!value.allFinite()) return fault("is damaged: uvs that are not finite");
      mesh.uvs.push_back(value);
    }
    mesh.face_uvs = std::move(corners);
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
    const TimeSampling& t = view_.times = archive_.time_samplings[view_.positions.time_sampling];
    double step = t.time_per_cycle / static_cast<double>(t.times.size());
    if (t.times.size() > 1)
      step = t.times[1] - t.times[0];  // unevenly spaced times have no frame rate; this is the best guess
    view_.info.has_fps = t.times.size() == 1 && view_.positions.time_sampling != 0;
    double fps = step > 0 ? 1 / step : 24;
    for (const double rate : {std::round(fps), std::round(fps * 1.001) / 1.001})  // undo the rounding of 1/fps
      if (rate > 0 && std::abs(rate - fps) < 1e-12 * fps) fps = rate;
    view_.info.fps = fps;
    const double frame = std::round(t.times.front() * fps);
    view_.info.first_frame = std::abs(frame) < 1e9 ? static_cast<int>(frame) : 0;
  }

  const InputFile& file_;
  const Archive& archive_;
  MeshView view_;
};

}  // namespace

Result<MeshView> find_mesh(const InputFile& file, const Archive& archive) {
  return Reader(file, archive).run();
}

}  // namespace ft::alembic

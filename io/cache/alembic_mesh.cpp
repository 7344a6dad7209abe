// Cache to archive: see alembic_mesh.h. Names, scopes and interpretations are those of AbcGeom's PolyMesh schema,
// version 1.
#include "io/cache/alembic_mesh.h"

#include <fmt/format.h>

#include <algorithm>

namespace ft::alembic {
namespace {

constexpr const char* k_application = "Followthrough";
constexpr const char* k_object_metadata =
    "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1;schemaObjTitle=AbcGeom_PolyMesh_v1:.geom";
constexpr const char* k_geom_metadata = "schema=AbcGeom_PolyMesh_v1;schemaBaseType=AbcGeom_GeomBase_v1";
constexpr const char* k_uv_metadata =
    "arrayExtent=1;geoScope=fvr;interpretation=vector;isGeomParam=true;podExtent=2;podName=float32_t";
constexpr const char* k_rest_metadata =
    "arrayExtent=1;geoScope=vtx;interpretation=point;isGeomParam=true;podExtent=3;podName=float32_t";
constexpr std::uint32_t k_shot_times = 1;  // index of the shot's time sampling

/// Names of objects and properties hold no '/', values of metadata no ';' and '='.
std::string plain(std::string text, std::string_view forbidden) {
  for (char& c : text)
    if (c == '\0' || forbidden.find(c) != std::string_view::npos) c = '_';
  return text.empty() ? "_" : text;
}

template <class T>
Sample append(ogawa::Builder& out, const std::vector<T>& values) {
  const auto raw = std::as_bytes(std::span(values));
  Sample s;
  s.data = out.data(sample_payload(raw));
  s.size = raw.empty() ? 0 : raw.size() + 16;
  if (!raw.empty()) s.key = murmur3(raw);
  return s;
}

std::vector<float> flat(std::span<const Vec3> points) {
  std::vector<float> out;
  for (const Vec3& p : points)
    for (int c = 0; c < 3; ++c) out.push_back(static_cast<float>(p[c]));
  return out;
}

}  // namespace

void reverse_faces(std::span<const int> face_sizes, std::vector<int>& corners) {
  auto face = corners.begin();
  for (const int size : face_sizes) {
    std::reverse(face, face + size);
    face += size;
  }
}

MeshTree::MeshTree(const CacheInfo& info)
    : system_(plain(info.system, "/")), fps_(info.fps), first_frame_(info.first_frame) {
  const Mesh& mesh = info.mesh;
  ogawa::Builder out(ogawa::k_header_size);
  std::vector<int> corners = mesh.face_vertices;
  reverse_faces(mesh.face_sizes, corners);
  face_indices_ = append(out, corners);
  face_sizes_ = append(out, mesh.face_sizes);
  rest_ = append(out, flat(mesh.positions));
  has_uvs_ = !mesh.uvs.empty() && mesh.face_uvs.size() == mesh.face_vertices.size();
  if (has_uvs_) {
    std::vector<float> values;
    for (const Vec2& uv : mesh.uvs)
      for (int c = 0; c < 2; ++c) values.push_back(static_cast<float>(uv[c]));
    std::vector<int> uv_corners = mesh.face_uvs;
    reverse_faces(mesh.face_sizes, uv_corners);
    uv_values_ = append(out, values);
    uv_indices_ = append(out, uv_corners);
  }
  for (const auto& [key, value] : info.metadata) {
    std::vector<char> text(value.begin(), std::find(value.begin(), value.end(), '\0'));
    text.push_back('\0');
    provenance_.emplace_back(plain(key, "/"), append(out, text));
  }
  static_bytes_ = out.take();
}

Archive MeshTree::archive(const FrameSamples& frames, std::uint32_t count) const {
  using enum PropertyKind;
  const auto first = [&](const std::vector<Sample>& all) { return std::span(all).first(count); };
  const std::uint32_t static_count = std::max(count, 1u);  // so that a cache without frames still has its topology
  std::vector<Property> geom;
  geom.push_back(
      animated(k_scalar, ".selfBnds", "interpretation=box", Pod::k_f64, 6, k_shot_times, first(frames.bounds)));
  geom.push_back(animated(k_array, "P", "geoScope=vtx;interpretation=point", Pod::k_f32, 3, k_shot_times,
                          first(frames.positions)));
  geom.push_back(constant(k_array, ".faceIndices", "", Pod::k_i32, 1, k_shot_times, face_indices_, static_count));
  geom.push_back(constant(k_array, ".faceCounts", "", Pod::k_i32, 1, k_shot_times, face_sizes_, static_count));
  if (count > 0 && !frames.velocities.empty())
    geom.push_back(animated(k_array, ".velocities", "interpretation=vector", Pod::k_f32, 3, k_shot_times,
                            first(frames.velocities)));
  if (has_uvs_)
    geom.push_back(compound("uv", k_uv_metadata,
                            {constant(k_array, ".vals", k_uv_metadata, Pod::k_f32, 2, 0, uv_values_, 1),
                             constant(k_array, ".indices", "", Pod::k_u32, 1, 0, uv_indices_, 1)}));
  geom.push_back(
      compound(".arbGeomParams", "", {constant(k_array, "Pref", k_rest_metadata, Pod::k_f32, 3, 0, rest_, 1)}));
  std::vector<Property> provenance;
  for (const auto& [key, sample] : provenance_)
    provenance.push_back(constant(k_scalar, key, "", Pod::k_string, 1, 0, sample, 1));
  geom.push_back(compound(".userProperties", "", std::move(provenance)));

  Archive archive;
  archive.metadata = fmt::format("_ai_Application={};_ai_DCC_FPS={:.6f};_ai_Description={}", k_application, fps_,
                                 plain(system_, ";="));
  archive.time_samplings.push_back({static_count, 1.0 / fps_, {first_frame_ / fps_}});
  Object mesh{system_, k_object_metadata, {compound(".geom", k_geom_metadata, std::move(geom))}, {}};
  archive.top.children.push_back(std::move(mesh));
  return archive;
}

std::uint64_t MeshTree::tail_bound(std::uint32_t capacity) const {
  FrameSamples fake;
  for (std::uint32_t i = 0; i < capacity; ++i) {
    Sample s;
    s.key.h1 = i;
    s.size = 17 + i % 2;
    fake.positions.push_back(s);
  }
  fake.velocities = fake.bounds = fake.positions;
  ogawa::Reference root = 0;
  constexpr std::uint64_t k_ranges = 3 * 8;  // first and last change of three properties, which the fake has not
  constexpr std::uint64_t k_sector = 512;
  return (emit(archive(fake, capacity), 0, root).size() + k_ranges + k_sector - 1) / k_sector * k_sector;
}

bool is_own(const Archive& archive) {
  return archive.metadata.starts_with(std::string("_ai_Application=") + k_application + ";");
}

}  // namespace ft::alembic

#include "io/import/gltf/gltf_primitive.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/import/gltf/gltf_draco.h"
#include "io/import/gltf/gltf_weights.h"

namespace ft::inline io::gltf {
namespace {

constexpr std::size_t k_most_morph_vertices = 50'000'000;  ///< over all morph targets: 1.2 GB

enum class Mode { k_triangles = 4, k_strip = 5, k_fan = 6 };

/// Corners of triangle i in the list of corners (glTF 2.0, 3.7.2.1).
std::array<std::size_t, 3> corners(Mode mode, std::size_t i) {
  if (mode == Mode::k_strip) return {i, i + 1 + i % 2, i + 2 - i % 2};
  if (mode == Mode::k_fan) return {i + 1, i + 2, 0};
  return {3 * i, 3 * i + 1, 3 * i + 2};
}

constexpr std::size_t k_most_triangles = 3 * k_max_character_vertices;  ///< over all meshes: 720 MB

/// corner(k): vertex of the k-th corner of the list.
template <class Corner>
void make_triangles(Mode mode, std::size_t corner_count, std::vector<Triangle>& out, MeshOddities& odd,
                    const Corner& corner) {
  const std::size_t n = mode == Mode::k_triangles ? corner_count / 3 : std::max<std::size_t>(corner_count, 2) - 2;
  if (mode == Mode::k_triangles && corner_count % 3 != 0) ++odd.cut_triangles;
  out.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto c = corners(mode, i);
    out.push_back({corner(c[0]), corner(c[1]), corner(c[2])});
  }
}

Status read_triangles(GltfFile& file, const Json& primitive, Mode mode, std::size_t vertex_count,
                      std::vector<Triangle>& out, MeshOddities& odd) {
  if (!primitive.contains("indices")) {
    make_triangles(mode, vertex_count, out, odd, [](std::size_t k) { return static_cast<int>(k); });
    return {};
  }
  auto indices = file.read(integer(member(primitive, "indices"), -1), Integers::k_themselves);
  if (!indices) return indices.error();
  if (indices->width != 1) return input_error("its indices are no single numbers");
  for (const double v : indices->values)
    if (!(v >= 0 && v < static_cast<double>(vertex_count)))
      return input_error("a triangle names vertex " + std::to_string(static_cast<std::int64_t>(v)) + " of " +
                         std::to_string(vertex_count));
  make_triangles(mode, indices->values.size(), out, odd,
                 [&](std::size_t k) { return static_cast<int>(indices->values[k]); });
  return {};
}

std::vector<Vec3> points(const AccessorValues& values) {
  std::vector<Vec3> out(values.count());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = {values.values[3 * i], values.values[3 * i + 1], values.values[3 * i + 2]};
  return out;
}

Status read_morphs(GltfFile& file, const Json& mesh, const Json& primitive, CharacterMesh& out) {
  const Json& targets = member(primitive, "targets");
  const Json& names = member(member(mesh, "extras"), "targetNames");
  for (std::size_t t = 0; t < size_of_array(targets); ++t) {
    MorphTarget morph{text(element(names, static_cast<std::int64_t>(t))), {}};
    const Json& position = member(targets[t], "POSITION");
    if (position.is_null()) {
      morph.deltas.assign(out.positions.size(), Vec3::Zero());
    } else {
      const std::string name = "morph target " + std::to_string(t);
      auto values = file.read(integer(position, -1), Integers::k_as_flagged);
      if (!values) return input_error(name + ": " + values.error().what);
      if (values->width != 3 || values->count() != out.positions.size())
        return input_error(name + " has " + std::to_string(values->count()) + " values of " +
                           std::to_string(values->width) + " numbers for " + std::to_string(out.positions.size()) +
                           " vertices");
      morph.deltas = points(*values);
    }
    out.morphs.push_back(std::move(morph));
  }
  return {};
}

template <class T>
void keep(std::vector<T>& values, const std::vector<int>& kept) {
  std::vector<T> out;
  out.reserve(kept.size());
  for (const int v : kept) out.push_back(std::move(values[static_cast<std::size_t>(v)]));
  values = std::move(out);
}

/// Primitives often share one list of vertices and use a small part of it each: the others go.
void drop_unused(Primitive& primitive) {
  CharacterMesh& mesh = primitive.mesh;
  std::vector<int> to(mesh.positions.size(), -1), kept;
  for (const Triangle& t : mesh.triangles)
    for (const int v : t) to[static_cast<std::size_t>(v)] = 0;
  for (std::size_t v = 0; v < to.size(); ++v)
    if (to[v] == 0) to[v] = static_cast<int>(kept.size()), kept.push_back(static_cast<int>(v));
  if (kept.size() == to.size()) return;
  for (Triangle& t : mesh.triangles)
    for (int& v : t) v = to[static_cast<std::size_t>(v)];
  keep(mesh.positions, kept);
  for (MorphTarget& morph : mesh.morphs) keep(morph.deltas, kept);
  if (primitive.weights.empty()) return;
  JointWeights rows;
  rows.start.push_back(0);
  for (const int v : kept) {
    const auto row = static_cast<std::size_t>(v);
    for (int k = primitive.weights.start[row]; k < primitive.weights.start[row + 1]; ++k) {
      rows.joint.push_back(primitive.weights.joint[static_cast<std::size_t>(k)]);
      rows.most_joint = std::max(rows.most_joint, rows.joint.back());
      rows.weight.push_back(primitive.weights.weight[static_cast<std::size_t>(k)]);
    }
    rows.start.push_back(static_cast<int>(rows.joint.size()));
  }
  primitive.weights = std::move(rows);
}

}  // namespace

std::vector<std::string> MeshOddities::notes() const {
  std::vector<std::string> out;
  if (least_sum < 0.999 || most_sum > 1.001) {
    char text[96];
    std::snprintf(text, sizeof text, "weights normalised (sums %.4g..%.4g)", least_sum, most_sum);
    out.emplace_back(text);
  }
  const auto count = [&](int n, const char* what) {
    if (n > 0) out.push_back(std::to_string(n) + " " + what);
  };
  count(unweighted, "vertices without a weight follow their mesh's node");
  count(bad_weights, "skin weights were negative, not finite or for no vertex; dropped");
  count(lonely_sets, "primitives have joints without weights, or weights without joints; those were left out");
  count(unskinned, "primitives of skinned nodes have no joints; they follow their node");
  count(lines, "primitives are points or lines; left out");
  count(without_positions, "primitives have no positions; left out");
  count(cut_triangles, "primitives end with a part of a triangle; it was left out");
  return out;
}

Status MeshRoom::take(std::size_t n, std::size_t targets) {
  if (n > k_max_character_vertices - vertices) return input_error("has more than 20 million vertices");
  if (targets > 0 && n > (k_most_morph_vertices - morph_vertices) / targets)
    return input_error("has morph targets of more than 50 million vertices together");
  vertices += n, morph_vertices += n * targets;
  return {};
}

Status MeshRoom::take_triangles(std::size_t n) {
  if (n > k_most_triangles - triangles) return input_error("has more than 60 million triangles");
  triangles += n;
  return {};
}

Result<Primitive> read_primitive(GltfFile& file, const Json& mesh, const Json& primitive, bool skinned, MeshRoom& room,
                                 MeshOddities& odd) {
  Primitive out;
  const std::int64_t mode_number = integer(member(primitive, "mode"), 4);
  const Json& attributes = member(primitive, "attributes");
  if (mode_number < 0 || mode_number > 6) return input_error("has the unknown mode " + std::to_string(mode_number));
  if (mode_number < 4) return ++odd.lines, out;
  const Json& position = member(attributes, "POSITION");
  if (position.is_null()) return ++odd.without_positions, out;
  const auto mode = static_cast<Mode>(mode_number);
  const std::size_t target_count = size_of_array(member(primitive, "targets"));
  const Json& draco = member(member(primitive, "extensions"), "KHR_draco_mesh_compression");
  auto vertex_count = static_cast<std::size_t>(file.count(integer(position, -1)));
  std::map<std::string, AccessorValues> unpacked;
  if (draco.is_object()) {
    auto decoded = read_draco(file, primitive, draco);
    if (!decoded) return decoded.error();
    vertex_count = decoded->vertex_count;
    out.mesh.triangles = std::move(decoded->triangles);
    unpacked = std::move(decoded->attributes);
  }
  if (Status s = room.take(vertex_count, target_count); !s) return s.error();
  const std::int64_t corner_count = file.count(integer(member(primitive, "indices"), -1));
  if (Status s = room.take_triangles(std::max(
          out.mesh.triangles.size(), static_cast<std::size_t>(corner_count) / (mode == Mode::k_triangles ? 3 : 1)));
      !s)
    return s.error();
  const auto attribute = [&](const char* semantic, Integers integers) -> Result<AccessorValues> {
    if (const auto found = unpacked.find(semantic); found != unpacked.end()) return std::move(found->second);
    return file.read(integer(member(attributes, semantic), -1), integers);
  };
  auto positions = attribute("POSITION", Integers::k_as_flagged);
  if (!positions) return input_error("positions: " + positions.error().what);
  if (positions->width != 3) return input_error("its positions have " + std::to_string(positions->width) + " numbers");
  out.mesh.positions = points(*positions);
  *positions = {};
  if (!draco.is_object())
    if (Status s = read_triangles(file, primitive, mode, out.mesh.positions.size(), out.mesh.triangles, odd); !s)
      return s.error();
  for (const Triangle& t : out.mesh.triangles)
    for (const int v : t)
      if (static_cast<std::size_t>(v) >= out.mesh.positions.size())
        return input_error("a triangle names vertex " + std::to_string(v) + " of " +
                           std::to_string(out.mesh.positions.size()));
  if (out.mesh.positions.empty() || out.mesh.triangles.empty()) return Primitive{};
  if (Status s = read_morphs(file, mesh, primitive, out.mesh); !s) return s.error();
  if (skinned) {
    auto weights = read_weights(attributes, attribute, out.mesh.positions.size(), odd);
    if (!weights) return weights.error();
    out.weights = std::move(*weights);
    if (out.weights.empty()) ++odd.unskinned;
  }
  drop_unused(out);
  return out;
}

}  // namespace ft::inline io::gltf

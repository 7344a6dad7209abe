// One CharacterMesh per use of a Geometry by a Model. Vertices are the control points; geometric transforms are put
// into them. Traps met: polygons of one or two corners, indices beyond the vertices, a second mesh on one node,
// FullWeights that hold weights of vertices (Blender).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "io/import/character/polygons.h"
#include "io/import/fbx/fbx_scene.h"
#include "io/import/fbx/fbx_skin.h"

namespace ft::inline io {
namespace {

struct MeshNotes {
  int small = 0, broken = 0, unfinished = 0, large = 0;  ///< polygons
  int bad_shapes = 0;                                    ///< shapes whose indices and offsets do not match
  std::vector<std::string> animated_visibility;          ///< nodes
};

/// Polygons of a Geometry; the last corner of each is stored as -1 - index.
std::vector<Triangle> read_triangles(const FbxNode& geometry, std::span<const Vec3> positions, MeshNotes& notes) {
  const std::vector<std::int32_t> indices = fbx_indices(geometry.child("PolygonVertexIndex"));
  std::vector<Triangle> out;
  out.reserve(indices.size() / 2);
  std::vector<int> corners;
  bool broken = false;
  for (const std::int32_t stored : indices) {
    const int vertex = stored < 0 ? -1 - stored : stored;
    broken = broken || static_cast<std::size_t>(vertex) >= positions.size();
    corners.push_back(vertex);
    if (stored >= 0) continue;
    if (broken)
      ++notes.broken;
    else if (corners.size() < 3)
      ++notes.small;
    else
      split_polygon(corners, positions, out);
    notes.large += corners.size() > k_max_ear_corners;
    corners.clear();
    broken = false;
  }
  notes.unfinished += !corners.empty();
  return out;
}

std::vector<Vec3> points_of(const FbxNode* node) {
  const std::vector<double> numbers = fbx_numbers(node);
  std::vector<Vec3> out(numbers.size() / 3);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = Eigen::Map<const Vec3>(numbers.data() + 3 * i);
  return out;
}

/// Weights of shapes at a percentage: straight between neighbours, with 0 % as a shape of no change; beyond the last
/// one the last piece goes on.
std::vector<double> weights_at(std::span<const double> full, double percent) {
  std::vector<double> out(full.size(), 0.0);
  const auto n = static_cast<std::ptrdiff_t>(full.size());
  const std::ptrdiff_t positive = std::lower_bound(full.begin(), full.end(), 0.0) - full.begin();
  // From 0 outwards, to the side that the percentage is on.
  const std::ptrdiff_t step = percent > 0 ? 1 : -1;
  std::ptrdiff_t from = -1, to = percent > 0 ? positive : positive - 1;
  if (to < 0 || to >= n) return out;
  const auto at = [&](std::ptrdiff_t k) { return full[static_cast<std::size_t>(k)]; };
  while (to + step >= 0 && to + step < n && std::abs(at(to)) <= std::abs(percent)) from = to, to += step;
  const double start = from < 0 ? 0 : at(from), length = at(to) - start;
  if (length == 0) return out;
  const double t = (percent - start) / length;
  if (from >= 0) out[static_cast<std::size_t>(from)] = 1 - t;
  out[static_cast<std::size_t>(to)] = t;
  return out;
}

double deform_percent(const FbxObject& channel) {
  if (channel.property("DeformPercent") != nullptr) return channel.number("DeformPercent", 0);
  const FbxNode* field = channel.node->child("DeformPercent");  // Blender
  return field != nullptr ? fbx_number(*field, 0, 100) : 0;
}

/// A shape's offsets on all vertices; `scale` are factors of single offsets, or empty.
MorphTarget read_shape(const FbxObject& shape, std::span<const double> scale, const Mat3& linear,
                       std::size_t vertex_count, MeshNotes& notes) {
  MorphTarget out{shape.name, std::vector<Vec3>(vertex_count, Vec3::Zero())};
  const std::vector<std::int32_t> indices = fbx_indices(shape.node->child("Indexes"));
  const std::vector<Vec3> offsets = points_of(shape.node->child("Vertices"));
  bool bad = indices.size() != offsets.size();
  for (std::size_t k = 0; k < std::min(indices.size(), offsets.size()); ++k) {
    if (indices[k] < 0 || static_cast<std::size_t>(indices[k]) >= vertex_count)
      bad = true;
    else
      out.deltas[static_cast<std::size_t>(indices[k])] += linear * offsets[k] * (scale.empty() ? 1.0 : scale[k]);
  }
  notes.bad_shapes += bad;
  return out;
}

/// All blend shapes of a mesh, their rest weights, and what animates them.
void read_shapes(const FbxDocument& document, const FbxObject& geometry, const Mat3& linear, CharacterMesh& mesh,
                 std::vector<double>& rest, std::vector<FbxShapeUse>& uses, MeshNotes& notes) {
  for (const FbxObject* deformer : document.members(geometry.id, "Deformer", "BlendShape"))
    for (const FbxObject* channel : document.members(deformer->id, "Deformer", "BlendShapeChannel")) {
      const auto shapes = document.members(channel->id, "Geometry", "Shape");
      std::vector<double> full = fbx_numbers(channel->node->child("FullWeights"));
      std::vector<double> scale;
      if (shapes.size() == 1 && full.size() > 1) {  // Blender: a weight [%] per offset
        if (full.size() == fbx_indices(shapes.front()->node->child("Indexes")).size())
          for (const double w : full) scale.push_back(w / 100);
        full.clear();
      }
      full.resize(shapes.size(), 100.0);
      std::vector<std::size_t> order(shapes.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return full[a] < full[b]; });
      FbxShapeUse use;
      use.channel = channel->id, use.node = mesh.node;
      for (const std::size_t k : order) {
        use.morphs.push_back(static_cast<int>(mesh.morphs.size()));
        use.full.push_back(full[k]);
        mesh.morphs.push_back(read_shape(*shapes[k], scale, linear, mesh.positions.size(), notes));
      }
      for (const double w : weights_at(use.full, deform_percent(*channel))) rest.push_back(w);
      if (!use.morphs.empty()) uses.push_back(std::move(use));
    }
}

/// Whether each model is drawn, as its own properties and those of the models above it say.
std::vector<char> visible_nodes(const FbxDocument& document, const FbxScene& scene, const Character& out,
                                MeshNotes& notes) {
  std::vector<char> shown(scene.models.size(), 1), drawn(scene.models.size(), 1);
  for (std::size_t i = 0; i < scene.models.size(); ++i) {
    const FbxObject& model = *scene.models[i];
    bool animated = false;
    for (const FbxConnection& c : document.into(model.id))
      animated = animated || c.destination_property == "Visibility";
    if (animated) notes.animated_visibility.push_back(model.name);
    const int parent = out.nodes[i].parent;
    const bool above =
        parent < 0 || shown[static_cast<std::size_t>(parent)] != 0 || model.integer("Visibility Inheritance", 1) == 0;
    shown[i] = above && (animated || model.number("Visibility", 1) != 0);
    drawn[i] = shown[i] != 0 && model.integer("Show", 1) != 0;
  }
  return drawn;
}

void write_mesh_notes(const MeshNotes& notes, Character& out) {
  const auto count = [&](int n, const char* what) {
    if (n > 0) out.notes.push_back(std::to_string(n) + " " + what);
  };
  count(notes.small, "polygons have one or two corners; left out");
  count(notes.broken, "polygons name a vertex that is not there; left out");
  count(notes.unfinished, "meshes end within a polygon; it was left out");
  count(notes.large, "polygons have more than 1024 corners; they were split as fans from their first corner");
  count(notes.bad_shapes, "blend shapes have offsets for no vertex; those were left out");
  for (const std::string& node : notes.animated_visibility)
    out.notes.push_back("the visibility of \"" + node + "\" is animated; it counts as visible throughout");
}

}  // namespace

Status read_fbx_meshes(const FbxDocument& document, FbxScene& scene, Character& out) {
  const std::vector<Mat4> globals = rest_globals(out.nodes);
  MeshNotes notes;
  FbxSkinNotes skin_notes;
  const FbxBindPoses bind_poses = read_bind_poses(document);
  const std::vector<char> visible = visible_nodes(document, scene, out, notes);
  std::size_t vertices = 0;
  const std::size_t model_count = scene.models.size();
  for (std::size_t i = 0; i < model_count; ++i) {
    const FbxObject& model = *scene.models[i];
    int node = static_cast<int>(i);
    for (const FbxObject* geometry : document.members(model.id, "Geometry", "Mesh")) {
      std::vector<Vec3> positions = points_of(geometry->node->child("Vertices"));
      vertices += positions.size();
      if (vertices > k_max_character_vertices) return input_error("has more than 20 million vertices");
      if (positions.empty()) continue;
      CharacterMesh mesh;
      mesh.name = geometry->name.empty() ? model.name : geometry->name;
      mesh.node = node;
      mesh.visible = visible[i] != 0;
      const Vec3 zero = Vec3::Zero();
      const Mat4 geometric =
          geometric_matrix(model.vector("GeometricTranslation", zero), model.vector("GeometricRotation", zero),
                           model.vector("GeometricScaling", Vec3::Ones()));
      const bool moved = !geometric.isIdentity(0);
      if (moved)
        for (Vec3& p : positions) p = (geometric * p.homogeneous()).head<3>();
      mesh.positions = std::move(positions);
      mesh.triangles = read_triangles(*geometry->node, mesh.positions, notes);
      read_fbx_skin(document, scene, bind_poses, globals, *geometry, mesh, skin_notes);
      std::vector<double> rest;
      const std::size_t first_use = scene.shapes.size();
      read_shapes(document, *geometry, geometric.topLeftCorner<3, 3>(), mesh, rest, scene.shapes, notes);
      if (!rest.empty() && !out.nodes[static_cast<std::size_t>(node)].morph_weights.empty()) {
        // Weights belong to nodes: a second mesh with shapes gets a node of its own, in the same place.
        mesh.node = static_cast<int>(out.nodes.size());
        out.nodes.push_back({mesh.name, node, Mat4::Identity(), {}});
        for (std::size_t u = first_use; u < scene.shapes.size(); ++u) scene.shapes[u].node = mesh.node;
      }
      if (!rest.empty()) out.nodes[static_cast<std::size_t>(mesh.node)].morph_weights = std::move(rest);
      out.meshes.push_back(std::move(mesh));
    }
  }
  write_mesh_notes(notes, out);
  write_notes(skin_notes, out);
  return {};
}

}  // namespace ft::inline io

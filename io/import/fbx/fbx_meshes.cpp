// One CharacterMesh per use of a Geometry by a Model. Vertices are the control points; geometric transforms are put
// into them. Traps met: polygons of one or two corners, indices beyond the vertices, a second mesh on one node,
// FullWeights that hold weights of vertices (Blender).
#include <Eigen/Geometry>

#include "io/import/character/polygons.h"
#include "io/import/character/pose.h"
#include "io/import/fbx/fbx_scene.h"
#include "io/import/fbx/fbx_shapes.h"
#include "io/import/fbx/fbx_skin.h"

namespace ft::inline io {
namespace {

struct MeshNotes {
  int small = 0, broken = 0, unfinished = 0, large = 0;  ///< polygons
  int bad_shapes = 0;                                    ///< shapes whose indices and offsets do not match
  std::string animated_visibility;                       ///< nodes
};

Mat4 geometric_matrix(const FbxObject& model) {
  const Vec3 zero = Vec3::Zero();
  Mat4 out = Mat4::Identity();
  out.topLeftCorner<3, 3>() =
      rotation_of(model.vector("GeometricRotation", zero), RotationOrder::k_xyz).toRotationMatrix() *
      model.vector("GeometricScaling", Vec3::Ones()).asDiagonal();
  out.topRightCorner<3, 1>() = model.vector("GeometricTranslation", zero);
  return out;
}

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

/// Whether any key of a property is not 0, and whether any is; without keys neither.
std::pair<bool, bool> keyed_states(const FbxDocument& document, const FbxObject& model, std::string_view property) {
  bool on = false, off = false;
  for (const FbxConnection& c : document.into(model.id)) {
    if (c.destination_property != property) continue;
    for (const FbxObject* curve : document.members_of_properties(c.source, "AnimationCurve"))
      for (const double value : fbx_numbers(curve->node->child("KeyValueFloat"))) (value != 0 ? on : off) = true;
  }
  return {on, off};
}

/// Whether each model is drawn, as its own properties and those of the models above it say.
std::vector<char> visible_nodes(const FbxDocument& document, const FbxScene& scene, const Character& out,
                                std::vector<char>& animated) {
  std::vector<char> shown(scene.models.size(), 1), drawn(scene.models.size(), 1);
  animated.assign(scene.models.size(), 0);
  for (std::size_t i = 0; i < scene.models.size(); ++i) {
    const FbxObject& model = *scene.models[i];
    const auto [on, off] = keyed_states(document, model, "Visibility");
    const bool own = on || (!off && model.number("Visibility", 1) != 0);
    const bool inherits = out.nodes[i].parent >= 0 && model.integer("Visibility Inheritance", 1) != 0;
    const auto parent = static_cast<std::size_t>(out.nodes[i].parent);
    shown[i] = own && (!inherits || shown[parent] != 0);
    animated[i] = (on && off) || (inherits && animated[parent] != 0);
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
  if (!notes.animated_visibility.empty())
    out.notes.push_back("meshes that appear or vanish by animation count as visible throughout: " +
                        notes.animated_visibility);
}

}  // namespace

Status read_fbx_meshes(const FbxDocument& document, FbxScene& scene, Character& out) {
  const std::vector<Mat4> globals = rest_globals(out.nodes);
  MeshNotes notes;
  FbxSkinNotes skin_notes;
  const FbxBindPoses bind_poses = read_bind_poses(document);
  std::vector<char> animated;
  const std::vector<char> visible = visible_nodes(document, scene, out, animated);
  std::size_t vertices = 0;
  const std::size_t model_count = scene.models.size();
  for (std::size_t i = 0; i < model_count; ++i) {
    const FbxObject& model = *scene.models[i];
    int node = static_cast<int>(i);
    for (const FbxObject* geometry : document.members(model.id, "Geometry", "Mesh")) {
      std::vector<Vec3> positions = fbx_points(geometry->node->child("Vertices"));
      vertices += positions.size();
      if (vertices > k_max_character_vertices) return input_error("has more than 20 million vertices");
      if (positions.empty()) continue;
      CharacterMesh mesh;
      mesh.name = geometry->name.empty() ? model.name : geometry->name;
      mesh.node = node;
      mesh.visible = visible[i] != 0;
      if (animated[i])
        notes.animated_visibility += (notes.animated_visibility.empty() ? "\"" : ", \"") + model.name + "\"";
      const Mat4 geometric = geometric_matrix(model);
      const bool moved = !geometric.isIdentity(0);
      if (moved)
        for (Vec3& p : positions) p = (geometric * p.homogeneous()).head<3>();
      mesh.positions = std::move(positions);
      mesh.triangles = read_triangles(*geometry->node, mesh.positions, notes);
      read_fbx_skin(document, scene, bind_poses, globals, *geometry, mesh, skin_notes);
      std::vector<double> rest;
      const std::size_t first_use = scene.shapes.size();
      notes.bad_shapes +=
          read_fbx_shapes(document, *geometry, geometric.topLeftCorner<3, 3>(), mesh, rest, scene.shapes);
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

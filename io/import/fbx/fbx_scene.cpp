#include "io/import/fbx/fbx_scene.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

constexpr double k_degree = M_PI / 180;

Mat4 rotation(const Vec3& angles_deg, std::int64_t order) {
  constexpr int k_axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};
  const auto& axes = k_axes[order >= 0 && order < 6 ? order : 0];
  Mat4 out = Mat4::Identity();
  for (const int axis : axes) {
    Mat4 turn = Mat4::Identity();
    turn.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angles_deg[axis] * k_degree, Vec3::Unit(axis)).toRotationMatrix();
    out = turn * out;
  }
  return out;
}

Mat4 translation(const Vec3& v) {
  Mat4 out = Mat4::Identity();
  out.topRightCorner<3, 1>() = v;
  return out;
}

/// T * Roff * Rp * Rpre * R * Rpost^-1 * Rp^-1 * Soff * Sp * S * Sp^-1, as the FBX SDK documents it.
Mat4 rest_local(const FbxObject& model) {
  const Vec3 zero = Vec3::Zero();
  const bool active = model.integer("RotationActive", 0) != 0;
  const Vec3 rotation_pivot = model.vector("RotationPivot", zero), scaling_pivot = model.vector("ScalingPivot", zero);
  Mat4 turn = rotation(model.vector("Lcl Rotation", zero), active ? model.integer("RotationOrder", 0) : 0);
  if (active)
    turn = rotation(model.vector("PreRotation", zero), 0) * turn *
           Mat4(rotation(model.vector("PostRotation", zero), 0).transpose());
  Mat4 scale = Mat4::Identity();
  scale.diagonal().head<3>() = model.vector("Lcl Scaling", Vec3::Ones());
  return translation(model.vector("Lcl Translation", zero)) *
         translation(model.vector("RotationOffset", zero) + rotation_pivot) * turn *
         translation(model.vector("ScalingOffset", zero) + scaling_pivot - rotation_pivot) * scale *
         translation(-scaling_pivot);
}

}  // namespace

int FbxScene::node_of(const FbxObject* model) const {
  const auto found = model != nullptr ? node_of_model.find(model->id) : node_of_model.end();
  return found != node_of_model.end() ? found->second : -1;
}

Mat4 geometric_matrix(const Vec3& move, const Vec3& angles_deg, const Vec3& scale) {
  Mat4 stretch = Mat4::Identity();
  stretch.diagonal().head<3>() = scale;
  return translation(move) * rotation(angles_deg, 0) * stretch;
}

std::vector<Mat4> rest_globals(const std::vector<CharacterNode>& nodes) {
  std::vector<Mat4> out(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int parent = nodes[i].parent;
    out[i] = parent < 0 ? nodes[i].local : Mat4(out[static_cast<std::size_t>(parent)] * nodes[i].local);
  }
  return out;
}

Result<FbxScene> read_fbx_nodes(const FbxDocument& document, Character& out) {
  FbxScene scene;
  std::vector<const FbxObject*> models;
  std::unordered_map<std::int64_t, std::size_t> index;
  for (const FbxObject& object : document.objects())
    if (object.kind == "Model") index.emplace(object.id, models.size()), models.push_back(&object);
  if (models.size() > k_max_character_nodes) return input_error("has more than 200,000 nodes");

  // Each model below one other; of several the last in the file, which is how other readers draw it.
  constexpr std::size_t k_none = static_cast<std::size_t>(-1);
  std::vector<std::size_t> parent(models.size(), k_none);
  std::vector<std::vector<std::size_t>> children(models.size());
  std::vector<std::size_t> roots;
  std::string several;
  for (std::size_t m = 0; m < models.size(); ++m) {
    bool more = false;
    for (const FbxConnection& c : document.out_of(models[m]->id)) {
      const auto found =
          c.destination_property.empty() && c.source_property.empty() ? index.find(c.destination) : index.end();
      if (found == index.end()) continue;
      more = more || (parent[m] != k_none && parent[m] != found->second);
      if (parent[m] == k_none || found->second > parent[m]) parent[m] = found->second;
    }
    if (more) several += (several.empty() ? "\"" : ", \"") + models[m]->name + "\"";
    if (parent[m] == k_none) roots.push_back(m);
  }
  std::vector<char> listed(models.size(), 0);
  for (std::size_t m = 0; m < models.size(); ++m)
    for (const FbxConnection& c : document.into(models[m]->id)) {
      const auto found = index.find(c.source);
      if (found == index.end() || parent[found->second] != m || listed[found->second]) continue;
      listed[found->second] = 1;
      children[m].push_back(found->second);
    }
  if (!several.empty()) out.notes.push_back("nodes stand below several others, and were put below one: " + several);

  struct Visit {
    std::size_t model;
    int parent;
  };
  std::vector<Visit> stack;
  for (auto r = roots.rbegin(); r != roots.rend(); ++r) stack.push_back({*r, -1});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const int node = static_cast<int>(out.nodes.size());
    out.nodes.push_back({models[visit.model]->name, visit.parent, rest_local(*models[visit.model]), {}});
    scene.models.push_back(models[visit.model]);
    scene.node_of_model.emplace(models[visit.model]->id, node);
    const auto& below = children[visit.model];
    for (auto c = below.rbegin(); c != below.rend(); ++c) stack.push_back({*c, node});
  }
  if (out.nodes.size() < models.size()) {
    for (const FbxObject* model : models)
      if (scene.node_of(model) < 0)
        return input_error("is damaged: node \"" + model->name + "\" stands below itself", "",
                           "open the file in its program and export it again");
  }
  if (out.nodes.empty()) return input_error("has no nodes: there is nothing in its scene");
  return scene;
}

}  // namespace ft::inline io

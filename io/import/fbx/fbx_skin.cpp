// "Transform" of a cluster takes the mesh's node to the bone in the bind pose, "TransformLink" the bone to the world.
#include "io/import/fbx/fbx_skin.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

namespace ft::inline io {
namespace {

struct Influence {
  int vertex = 0, bone = 0;
  double weight = 0;
};

/// Files store columns one after the other. None when there are no 16 finite numbers, or only zeros.
std::optional<Mat4> matrix_of(const FbxNode& node, std::string_view name) {
  const std::vector<double> values = fbx_numbers(node.child(name));
  if (values.size() < 16) return {};
  const Mat4 m = Eigen::Map<const Mat4>(values.data());
  if (!m.allFinite() || m.isZero(0)) return {};
  return m;
}

Mat4 inverse_bind_of(const FbxBindPoses& bind_poses, const FbxObject& cluster, const FbxObject& bone,
                     const Mat4& bone_global, const Mat4& mesh_global, FbxSkinNotes& notes) {
  if (const auto transform = matrix_of(*cluster.node, "Transform")) return *transform;
  ++notes.added_binds;
  auto link = matrix_of(*cluster.node, "TransformLink");
  if (const auto pose = bind_poses.find(bone.id); !link && pose != bind_poses.end())
    link = matrix_of(*pose->second, "Matrix");
  const Mat4 inverse = link.value_or(bone_global).inverse();
  return inverse.allFinite() ? Mat4(inverse * mesh_global) : Mat4::Identity();
}

void read_cluster(const FbxObject& cluster, int bone, std::size_t vertex_count, std::vector<Influence>& all,
                  FbxSkinNotes& notes) {
  const std::vector<std::int32_t> indices = fbx_indices(cluster.node->child("Indexes"));
  const std::vector<double> weights = fbx_numbers(cluster.node->child("Weights"));
  if (indices.size() != weights.size())
    notes.bad += static_cast<int>(std::max(indices.size(), weights.size()) - std::min(indices.size(), weights.size()));
  for (std::size_t k = 0; k < std::min(indices.size(), weights.size()); ++k) {
    if (weights[k] == 0) continue;
    if (!(weights[k] > 0 && weights[k] < 1e6) || indices[k] < 0 || static_cast<std::size_t>(indices[k]) >= vertex_count)
      ++notes.bad;
    else
      all.push_back({indices[k], bone, weights[k]});
  }
}

/// Rows that sum to 1. Returns the largest distance of a sum from that.
double fill_rows(std::vector<Influence>& all, bool rigid, CharacterMesh& mesh, FbxSkinNotes& notes) {
  std::stable_sort(all.begin(), all.end(), [](const Influence& a, const Influence& b) {
    return std::tie(a.vertex, a.bone) < std::tie(b.vertex, b.bone);
  });
  double farthest = 0;
  std::size_t k = 0;
  mesh.influence_start.reserve(mesh.positions.size() + 1);
  mesh.influence_start.push_back(0);
  mesh.influence_bone.reserve(all.size()), mesh.influence_weight.reserve(all.size());
  for (int v = 0; v < static_cast<int>(mesh.positions.size()); ++v) {
    const std::size_t row = mesh.influence_bone.size();
    double sum = 0;
    for (; k < all.size() && all[k].vertex == v; ++k) {
      if (mesh.influence_bone.size() > row && mesh.influence_bone.back() == all[k].bone)
        mesh.influence_weight.back() += all[k].weight;
      else
        mesh.influence_bone.push_back(all[k].bone), mesh.influence_weight.push_back(all[k].weight);
      sum += all[k].weight;
    }
    if (mesh.influence_bone.size() == row) {
      ++notes.unweighted;
    } else {
      notes.least = std::min(notes.least, sum), notes.most = std::max(notes.most, sum);
      farthest = std::max(farthest, std::abs(sum - 1));
      notes.rigid_blends += rigid && mesh.influence_bone.size() > row + 1;
    }
    for (std::size_t i = row; i < mesh.influence_weight.size(); ++i)
      mesh.influence_weight[i] = std::min(1.0, mesh.influence_weight[i] / sum);
    mesh.influence_start.push_back(static_cast<int>(mesh.influence_bone.size()));
  }
  return farthest;
}

/// Shares of dual quaternions; empty for linear skins.
std::vector<double> dual_shares(const FbxObject& skin, const std::string& type, std::size_t vertex_count) {
  if (type != "DualQuaternion" && type != "Blend") return {};
  std::vector<double> out(vertex_count, type == "Blend" ? 0.0 : 1.0);
  const std::vector<std::int32_t> indices = fbx_indices(skin.node->child("Indexes"));
  const std::vector<double> shares = fbx_numbers(skin.node->child("BlendWeights"));
  for (std::size_t k = 0; k < std::min(indices.size(), shares.size()); ++k)
    if (indices[k] >= 0 && static_cast<std::size_t>(indices[k]) < vertex_count && std::isfinite(shares[k]))
      out[static_cast<std::size_t>(indices[k])] = std::clamp(shares[k], 0.0, 1.0);
  return out;
}

}  // namespace

FbxBindPoses read_bind_poses(const FbxDocument& document) {
  FbxBindPoses out;
  for (const FbxObject& pose : document.objects()) {
    if (pose.kind != "Pose" || pose.subkind != "BindPose") continue;
    for (const FbxNode& entry : pose.node->children)
      if (const FbxNode* id = entry.name == "PoseNode" ? entry.child("Node") : nullptr; id != nullptr)
        out.emplace(fbx_integer(*id, 0), &entry);
  }
  return out;
}

void read_fbx_skin(const FbxDocument& document, const FbxScene& scene, const FbxBindPoses& bind_poses,
                   std::span<const Mat4> globals, const FbxObject& geometry, CharacterMesh& mesh, FbxSkinNotes& notes) {
  const auto skins = document.members(geometry.id, "Deformer", "Skin");
  if (skins.empty()) return;
  if (skins.size() > 1) notes.several.push_back(mesh.name);
  const FbxObject& skin = *skins.front();
  std::vector<Influence> all;
  int odd_modes = 0;
  for (const FbxObject* cluster : document.members(skin.id, "Deformer", "Cluster")) {
    const auto models = document.members(cluster->id, "Model");
    const int node = models.empty() ? -1 : scene.node_of(models.front());
    if (node < 0) {
      ++notes.lost_clusters;
      continue;
    }
    if (const FbxNode* mode = cluster->node->child("Mode"); mode != nullptr && fbx_text(*mode, 0) != "Normalize")
      ++odd_modes;
    const int bone = static_cast<int>(mesh.bones.size());
    mesh.bones.push_back(
        {node, inverse_bind_of(bind_poses, *cluster, *models.front(), globals[static_cast<std::size_t>(node)],
                               globals[static_cast<std::size_t>(mesh.node)], notes)});
    read_cluster(*cluster, bone, mesh.positions.size(), all, notes);
  }
  if (mesh.bones.empty()) return;
  const FbxNode* type_node = skin.node->child("SkinningType");
  const std::string type = type_node != nullptr ? fbx_text(*type_node, 0) : std::string();
  if (fill_rows(all, type == "Rigid", mesh, notes) > 1e-3) notes.odd_modes += odd_modes;
  mesh.dual_share = dual_shares(skin, type, mesh.positions.size());
}

void write_notes(const FbxSkinNotes& notes, Character& out) {
  if (notes.least < 0.999 || notes.most > 1.001) {
    char text[160];
    std::snprintf(text, sizeof text, "weights normalised (sums %.4g..%.4g)", notes.least, notes.most);
    out.notes.emplace_back(text);
  }
  const auto count = [&](int n, const char* what) {
    if (n > 0) out.notes.push_back(std::to_string(n) + " " + what);
  };
  count(notes.unweighted, "vertices without a weight follow their mesh's node");
  count(notes.bad, "skin weights were negative, not finite or for no vertex; dropped");
  count(notes.lost_clusters, "clusters of skins have no bone; their weights were dropped");
  count(notes.odd_modes, "clusters add their weights or leave a rest to the mesh; they were normalised instead");
  count(notes.added_binds, "clusters have no bind matrix; it was made from the bone's bind pose or rest pose");
  count(notes.rigid_blends, "vertices of rigid skins have several bones; they were blended");
  for (const std::string& mesh : notes.several)
    out.notes.push_back("mesh \"" + mesh + "\" has several skins; only the first was used");
}

}  // namespace ft::inline io

// Meshes: positions in the file's order, triangles, skin, morph targets. One CharacterMesh per use of a mesh by a node.
// Traps met: weights that do not sum to 1 (0.185 to 1.755 in good files), zero weights kept by assimp, bones named
// twice, and faces that are no triangles after Triangulate.
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "io/import/files/assimp_read.h"

namespace ft::inline io {
namespace {

Mat4 matrix(const aiMatrix4x4& m) {
  Mat4 out;
  for (unsigned r = 0; r < 4; ++r)
    for (unsigned c = 0; c < 4; ++c) out(r, c) = static_cast<double>(m[r][c]);
  return out;
}

Vec3 point(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// What was odd about weights, over all meshes.
struct WeightNotes {
  double least = 1, most = 1;
  int unweighted = 0, bad = 0, ambiguous = 0, lost = 0;
};

using NodesByName = std::unordered_map<std::string, std::vector<int>>;

/// Among nodes of one name, the one in whose bind pose the mesh is nearest to where its own node puts it.
int find_bone(const aiBone& bone, const NodesByName& by_name, const std::vector<Mat4>& globals, int mesh_node,
              WeightNotes& notes) {
  const auto found = by_name.find(bone.mName.C_Str());
  if (found == by_name.end()) return -1;
  const std::vector<int>& candidates = found->second;
  if (candidates.size() == 1) return candidates.front();
  ++notes.ambiguous;
  const Mat4 inverse_bind = matrix(bone.mOffsetMatrix);
  int best = candidates.front();
  double least = std::numeric_limits<double>::infinity();
  for (const int node : candidates) {
    const double distance =
        (globals[static_cast<std::size_t>(node)] * inverse_bind - globals[static_cast<std::size_t>(mesh_node)])
            .cwiseAbs()
            .maxCoeff();
    if (distance < least) least = distance, best = node;
  }
  return best;
}

void read_skin(const aiMesh& mesh, const NodesByName& by_name, const std::vector<Mat4>& globals, CharacterMesh& out,
               WeightNotes& notes) {
  struct Influence {
    int vertex, bone;
    double weight;
  };
  std::vector<Influence> all;
  for (unsigned b = 0; b < mesh.mNumBones; ++b) {
    const aiBone& bone = *mesh.mBones[b];
    const int node = find_bone(bone, by_name, globals, out.node, notes);
    if (node < 0) {
      ++notes.lost;
      continue;
    }
    const int index = static_cast<int>(out.bones.size());
    out.bones.push_back({node, matrix(bone.mOffsetMatrix)});
    for (unsigned k = 0; k < bone.mNumWeights; ++k) {
      const aiVertexWeight& w = bone.mWeights[k];
      const double weight = static_cast<double>(w.mWeight);
      if (weight == 0) continue;
      if (!(weight > 0 && weight < 1e6) || w.mVertexId >= mesh.mNumVertices)
        ++notes.bad;
      else
        all.push_back({static_cast<int>(w.mVertexId), index, weight});
    }
  }
  if (out.bones.empty()) return;
  std::sort(all.begin(), all.end(), [](const Influence& a, const Influence& b) {
    return std::tie(a.vertex, a.bone, a.weight) < std::tie(b.vertex, b.bone, b.weight);
  });
  std::size_t k = 0;
  out.influence_start.push_back(0);
  for (int v = 0; v < static_cast<int>(mesh.mNumVertices); ++v) {
    const std::size_t row = out.influence_bone.size();
    double sum = 0;
    for (; k < all.size() && all[k].vertex == v; ++k) {
      if (out.influence_bone.size() > row && out.influence_bone.back() == all[k].bone)
        out.influence_weight.back() += all[k].weight;
      else
        out.influence_bone.push_back(all[k].bone), out.influence_weight.push_back(all[k].weight);
      sum += all[k].weight;
    }
    if (out.influence_bone.size() == row)
      ++notes.unweighted;
    else
      notes.least = std::min(notes.least, sum), notes.most = std::max(notes.most, sum);
    for (std::size_t i = row; i < out.influence_weight.size(); ++i)
      out.influence_weight[i] = std::min(1.0, out.influence_weight[i] / sum);
    out.influence_start.push_back(static_cast<int>(out.influence_bone.size()));
  }
}

CharacterMesh read_mesh(const aiMesh& mesh, int node, int& odd_faces) {
  CharacterMesh out;
  out.name = mesh.mName.C_Str();
  out.node = node;
  out.positions.reserve(mesh.mNumVertices);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) out.positions.push_back(point(mesh.mVertices[i]));
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices != 3) {
      ++odd_faces;
      continue;
    }
    out.triangles.push_back(
        {static_cast<int>(face.mIndices[0]), static_cast<int>(face.mIndices[1]), static_cast<int>(face.mIndices[2])});
  }
  for (unsigned m = 0; m < mesh.mNumAnimMeshes; ++m) {
    const aiAnimMesh& target = *mesh.mAnimMeshes[m];
    MorphTarget morph{target.mName.C_Str(), std::vector<Vec3>(mesh.mNumVertices, Vec3::Zero())};
    if (target.mVertices != nullptr && target.mNumVertices == mesh.mNumVertices)
      for (unsigned i = 0; i < mesh.mNumVertices; ++i) morph.deltas[i] = point(target.mVertices[i]) - out.positions[i];
    out.morphs.push_back(std::move(morph));
  }
  return out;
}

}  // namespace

void read_meshes(const aiScene& scene, const std::vector<const aiNode*>& nodes, Character& out) {
  NodesByName by_name;
  std::vector<Mat4> globals(out.nodes.size());
  for (std::size_t i = 0; i < out.nodes.size(); ++i) {
    by_name[out.nodes[i].name].push_back(static_cast<int>(i));
    const int parent = out.nodes[i].parent;
    globals[i] = parent < 0 ? out.nodes[i].local : Mat4(globals[static_cast<std::size_t>(parent)] * out.nodes[i].local);
  }
  WeightNotes notes;
  int odd_faces = 0;
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const aiNode& raw = *nodes[i];
    for (unsigned k = 0; k < raw.mNumMeshes; ++k) {
      if (raw.mMeshes[k] >= scene.mNumMeshes || scene.mMeshes[raw.mMeshes[k]] == nullptr) continue;
      const aiMesh& mesh = *scene.mMeshes[raw.mMeshes[k]];
      vertices += mesh.mNumVertices;
      if (!mesh.HasPositions() || vertices > k_max_character_vertices) continue;
      const int node = static_cast<int>(i);
      CharacterMesh& added = out.meshes.emplace_back(read_mesh(mesh, node, odd_faces));
      read_skin(mesh, by_name, globals, added, notes);
      auto& weights = out.nodes[static_cast<std::size_t>(node)].morph_weights;
      if (weights.size() < added.morphs.size()) weights.resize(added.morphs.size(), 0.0);
    }
  }
  char text[160];
  if (notes.least < 0.999 || notes.most > 1.001) {
    std::snprintf(text, sizeof text, "weights normalised (sums %.4g..%.4g)", notes.least, notes.most);
    out.notes.emplace_back(text);
  }
  const auto count = [&](int n, const char* what) {
    if (n > 0) out.notes.push_back(std::to_string(n) + " " + what);
  };
  count(notes.unweighted, "vertices without a weight follow their mesh's node");
  count(notes.bad, "skin weights were negative, not finite or for no vertex; dropped");
  count(notes.lost, "bones have no node; their weights were dropped");
  count(notes.ambiguous, "bones have a name that several nodes carry; the node nearest to the bind pose was taken");
  count(odd_faces, "faces are no triangles; dropped");
  if (vertices > k_max_character_vertices)
    out.notes.emplace_back("more than 20 million vertices; the rest was dropped");
}

}  // namespace ft::inline io

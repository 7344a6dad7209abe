#include "io/import/body/bind.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

bool invertible(const Mat4& m) {
  const double size = m.topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
  return size > 0 && std::abs((m.topLeftCorner<3, 3>() / size).determinant()) > 1e-12;
}

/// How far two matrices put the points of a box apart.
double distance(const Mat4& a, const Mat4& b, const Box& box) {
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(corner & 1 ? box.lo.x() : box.hi.x(), corner & 2 ? box.lo.y() : box.hi.y(),
                 corner & 4 ? box.lo.z() : box.hi.z());
    most = std::max(most, ((a - b) * p.homogeneous()).head<3>().norm());
  }
  return most;
}

/// For each bone with a weight: where rest puts mesh space, global * inverse bind.
struct SkinAtRest {
  std::vector<int> bones;  // into mesh.bones, those with weights, parents first
  std::vector<Mat4> mesh_to_world;
  Box box;
  double tolerance = 0;  // file units
};

SkinAtRest skin_at_rest(const CharacterMesh& mesh, const std::vector<Mat4>& globals) {
  SkinAtRest out;
  std::vector<char> used(mesh.bones.size(), 0);
  for (const int b : mesh.influence_bone) used[static_cast<std::size_t>(b)] = 1;
  for (std::size_t b = 0; b < mesh.bones.size(); ++b)
    if (used[b] && invertible(mesh.bones[b].inverse_bind)) out.bones.push_back(static_cast<int>(b));
  std::stable_sort(out.bones.begin(), out.bones.end(), [&](int a, int b) {
    return mesh.bones[static_cast<std::size_t>(a)].node < mesh.bones[static_cast<std::size_t>(b)].node;
  });
  for (const int b : out.bones) {
    const SkinBone& bone = mesh.bones[static_cast<std::size_t>(b)];
    out.mesh_to_world.push_back(globals[static_cast<std::size_t>(bone.node)] * bone.inverse_bind);
  }
  out.box = bounds(mesh.positions);
  if (!out.bones.empty() && !out.box.empty()) {
    const double scale = out.mesh_to_world.front().topLeftCorner<3, 3>().cwiseAbs().maxCoeff();
    out.tolerance = 1e-3 * scale * out.box.size().norm();
  }
  return out;
}

}  // namespace

BindPose find_bind_pose(const Character& character) {
  const std::size_t n = character.nodes.size();
  BindPose out;
  out.globals = rest_globals(character.nodes);
  for (const CharacterNode& node : character.nodes) out.locals.push_back(node.local);

  std::vector<char> known(n, 0);
  std::vector<Mat4> bound(n);
  for (const CharacterMesh& mesh : character.meshes) {
    if (mesh.bones.empty() || mesh.positions.empty()) continue;
    const SkinAtRest rest = skin_at_rest(mesh, out.globals);
    if (rest.bones.empty()) continue;
    // All bones agree on where the mesh is: the rest pose is the bind pose, perhaps moved as a whole.
    const Mat4& first = rest.mesh_to_world.front();
    const bool rests = std::all_of(rest.mesh_to_world.begin(), rest.mesh_to_world.end(),
                                   [&](const Mat4& m) { return distance(m, first, rest.box) <= rest.tolerance; });
    // Else the mesh's own node says where it was bound, if some bone agrees with it; else the first bone.
    const Mat4& node = out.globals[static_cast<std::size_t>(mesh.node)];
    const bool node_agrees = std::any_of(rest.mesh_to_world.begin(), rest.mesh_to_world.end(),
                                         [&](const Mat4& m) { return distance(m, node, rest.box) <= rest.tolerance; });
    const Mat4 place = rests || !node_agrees ? first : node;
    if (!rests) out.from_inverse_binds = true;
    for (const int b : rest.bones) {
      const SkinBone& bone = mesh.bones[static_cast<std::size_t>(b)];
      const auto index = static_cast<std::size_t>(bone.node);
      if (known[index]) continue;
      known[index] = 1;
      bound[index] = place * bone.inverse_bind.inverse();
    }
  }
  if (!out.from_inverse_binds) return out;
  for (std::size_t i = 0; i < n; ++i) {
    const int parent = character.nodes[i].parent;
    const Mat4 above = parent < 0 ? Mat4::Identity().eval() : out.globals[static_cast<std::size_t>(parent)];
    if (known[i] && invertible(above) && bound[i].allFinite()) out.locals[i] = above.inverse() * bound[i];
    out.globals[i] = above * out.locals[i];
  }
  return out;
}

int find_pelvis(const Character& character, const std::vector<int>& meshes) {
  std::vector<char> carries(character.nodes.size(), 0);
  for (const int m : meshes) {
    const CharacterMesh& mesh = character.meshes[static_cast<std::size_t>(m)];
    if (mesh.bones.empty()) carries[static_cast<std::size_t>(mesh.node)] = 1;
    for (const int b : mesh.influence_bone)
      carries[static_cast<std::size_t>(mesh.bones[static_cast<std::size_t>(b)].node)] = 1;
  }
  int common = -1;
  for (int i = 0; i < static_cast<int>(carries.size()); ++i) {
    if (!carries[static_cast<std::size_t>(i)]) continue;
    if (common < 0) common = i;
    int a = common, b = i;
    while (a != b && a >= 0 && b >= 0) {  // parents come first, so the larger index is never above the smaller
      if (a > b)
        a = character.nodes[static_cast<std::size_t>(a)].parent;
      else
        b = character.nodes[static_cast<std::size_t>(b)].parent;
    }
    if (a != b) return 0;  // several roots
    common = a;
  }
  return std::max(common, 0);
}

}  // namespace ft::inline io

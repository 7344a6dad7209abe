#include "io/import/body/skin.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "baker/core/parallel.h"
#include "io/import/body/dual_quaternions.h"

namespace ft::inline io {
namespace {

/// Bindings of all meshes, each (node, inverse bind) once.
class BindingTable {
 public:
  int add(int node, const Mat4& inverse_bind, std::vector<Skin::Binding>& bindings) {
    std::string key(reinterpret_cast<const char*>(&node), sizeof node);
    key.append(reinterpret_cast<const char*>(inverse_bind.data()), sizeof(double) * 16);
    const auto [entry, fresh] = index_.emplace(std::move(key), static_cast<int>(bindings.size()));
    if (fresh) bindings.push_back({node, inverse_bind});
    return entry->second;
  }

 private:
  std::unordered_map<std::string, int> index_;
};

void append(std::string& key, const Vec3& v) {
  for (int k = 0; k < 3; ++k) {
    const double x = v[k] + 0.0;  // one zero, not two
    key.append(reinterpret_cast<const char*>(&x), sizeof x);
  }
}

bool degenerate(const Triangle& t, const std::vector<Vec3>& p) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  const Vec3 &a = p[static_cast<std::size_t>(t[0])], &b = p[static_cast<std::size_t>(t[1])],
             &c = p[static_cast<std::size_t>(t[2])];
  const Vec3 u = b - a, v = c - a, w = c - b;
  const double longest = std::max({u.squaredNorm(), v.squaredNorm(), w.squaredNorm()});
  return !(u.cross(v).norm() > 1e-9 * longest);
}

/// Keeps vertices that a triangle uses, in their order.
void drop_unused(Skin& skin) {
  std::vector<int> to(skin.base.size(), -1);
  for (const Triangle& t : skin.surface.triangles)
    for (const int v : t) to[static_cast<std::size_t>(v)] = 0;
  Skin kept;
  kept.start.push_back(0);
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] < 0) continue;
    to[i] = static_cast<int>(kept.base.size());
    kept.base.push_back(skin.base[i]);
    kept.origins.push_back(skin.origins[i]);
    if (!skin.dual_share.empty()) kept.dual_share.push_back(skin.dual_share[i]);
    for (int k = skin.start[i]; k < skin.start[i + 1]; ++k) {
      kept.binding.push_back(skin.binding[static_cast<std::size_t>(k)]);
      kept.weight.push_back(skin.weight[static_cast<std::size_t>(k)]);
    }
    kept.start.push_back(static_cast<int>(kept.binding.size()));
  }
  for (const Skin::Morph& morph : skin.morphs) {
    Skin::Morph m{morph.weight_index, {}, {}};
    for (std::size_t k = 0; k < morph.vertices.size(); ++k)
      if (const int v = to[static_cast<std::size_t>(morph.vertices[k])]; v >= 0)
        m.vertices.push_back(v), m.deltas.push_back(morph.deltas[k]);
    if (!m.vertices.empty()) kept.morphs.push_back(std::move(m));
  }
  kept.bindings = std::move(skin.bindings);
  for (Triangle t : skin.surface.triangles) {
    for (int& v : t) v = to[static_cast<std::size_t>(v)];
    kept.surface.triangles.push_back(t);
  }
  skin = std::move(kept);
}

}  // namespace

Skin weld(const Character& character, const std::vector<int>& meshes, std::vector<std::string>& notes) {
  Skin skin;
  skin.start.push_back(0);
  BindingTable table;
  std::unordered_map<std::string, int> seen;
  std::vector<int> morph_start{0};
  for (const CharacterNode& node : character.nodes)
    morph_start.push_back(morph_start.back() + static_cast<int>(node.morph_weights.size()));
  const bool any_dual = std::any_of(meshes.begin(), meshes.end(), [&](int m) {
    return !character.meshes[static_cast<std::size_t>(m)].dual_share.empty();
  });
  int split = 0, flat = 0;
  std::string key;
  for (const int m : meshes) {
    const CharacterMesh& mesh = character.meshes[static_cast<std::size_t>(m)];
    std::vector<int> binding_of_bone;
    for (const SkinBone& bone : mesh.bones)
      binding_of_bone.push_back(table.add(bone.node, bone.inverse_bind, skin.bindings));
    const int own = table.add(mesh.node, Mat4::Identity(), skin.bindings);
    const int first_morph = morph_start[static_cast<std::size_t>(mesh.node)];
    const int morph_room = morph_start[static_cast<std::size_t>(mesh.node) + 1] - first_morph;
    const std::size_t morph_count = std::min(mesh.morphs.size(), static_cast<std::size_t>(morph_room));
    const std::size_t morphs_before = skin.morphs.size();
    for (std::size_t k = 0; k < morph_count; ++k) skin.morphs.push_back({first_morph + static_cast<int>(k), {}, {}});

    std::vector<int> to(mesh.positions.size());
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const std::size_t row = skin.binding.size();
      if (!mesh.bones.empty())
        for (int k = mesh.influence_start[v]; k < mesh.influence_start[v + 1]; ++k) {
          skin.binding.push_back(
              binding_of_bone[static_cast<std::size_t>(mesh.influence_bone[static_cast<std::size_t>(k)])]);
          skin.weight.push_back(mesh.influence_weight[static_cast<std::size_t>(k)]);
        }
      if (skin.binding.size() == row) skin.binding.push_back(own), skin.weight.push_back(1);
      key.clear();
      append(key, mesh.positions[v]);
      for (std::size_t k = row; k < skin.binding.size(); ++k) {
        const auto rounded = static_cast<std::int32_t>(std::lround(skin.weight[k] * 1e5));
        key.append(reinterpret_cast<const char*>(&skin.binding[k]), sizeof(int));
        key.append(reinterpret_cast<const char*>(&rounded), sizeof rounded);
      }
      for (std::size_t k = 0; k < morph_count; ++k)
        if (const Vec3& d = mesh.morphs[k].deltas[v]; !d.isZero(0)) {
          key.append(reinterpret_cast<const char*>(&skin.morphs[morphs_before + k].weight_index), sizeof(int));
          append(key, d);
        }
      const double dual_share = mesh.dual_share.empty() ? 0 : mesh.dual_share[v];
      if (dual_share > 0) key.append(reinterpret_cast<const char*>(&dual_share), sizeof dual_share);
      const auto [entry, fresh] = seen.emplace(key, static_cast<int>(skin.base.size()));
      to[v] = entry->second;
      if (!fresh) {
        ++split;
        skin.binding.resize(row), skin.weight.resize(row);
        continue;
      }
      skin.base.push_back(mesh.positions[v]);
      skin.origins.push_back({m, static_cast<int>(v)});
      skin.start.push_back(static_cast<int>(skin.binding.size()));
      if (any_dual) skin.dual_share.push_back(dual_share);
      for (std::size_t k = 0; k < morph_count; ++k)
        if (const Vec3& d = mesh.morphs[k].deltas[v]; !d.isZero(0)) {
          skin.morphs[morphs_before + k].vertices.push_back(to[v]);
          skin.morphs[morphs_before + k].deltas.push_back(d);
        }
    }
    for (const Triangle& t : mesh.triangles) {
      const Triangle joined{to[static_cast<std::size_t>(t[0])], to[static_cast<std::size_t>(t[1])],
                            to[static_cast<std::size_t>(t[2])]};
      if (degenerate(joined, skin.base))
        ++flat;
      else
        skin.surface.triangles.push_back(joined);
    }
  }
  drop_unused(skin);
  if (split > 0) notes.push_back(std::to_string(split) + " split vertices joined");
  if (flat > 0) notes.push_back(std::to_string(flat) + " triangles without area dropped");
  return skin;
}

void deform(const Skin& skin, const Mat4& placement, std::span<const Mat4> globals,
            std::span<const double> morph_weights, std::span<Vec3> positions) {
  using Mat34 = Eigen::Matrix<double, 3, 4>;
  std::vector<Mat34> matrices(skin.bindings.size());
  for (std::size_t b = 0; b < matrices.size(); ++b) {
    const Skin::Binding& binding = skin.bindings[b];
    matrices[b] = (placement * globals[static_cast<std::size_t>(binding.node)] * binding.inverse_bind).topRows<3>();
  }
  std::vector<RigidPart> parts;
  if (!skin.dual_share.empty())
    for (const Mat34& m : matrices) parts.push_back(rigid_part(m));
  std::copy(skin.base.begin(), skin.base.end(), positions.begin());
  for (const Skin::Morph& morph : skin.morphs) {
    const double w = morph_weights[static_cast<std::size_t>(morph.weight_index)];
    if (w == 0) continue;
    for (std::size_t k = 0; k < morph.vertices.size(); ++k)
      positions[static_cast<std::size_t>(morph.vertices[k])] += w * morph.deltas[k];
  }
  parallel_for(skin.base.size(), 2048, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector4d p = positions[i].homogeneous();
      Vec3 sum = Vec3::Zero();
      for (int k = skin.start[i]; k < skin.start[i + 1]; ++k)
        sum += skin.weight[static_cast<std::size_t>(k)] *
               (matrices[static_cast<std::size_t>(skin.binding[static_cast<std::size_t>(k)])] * p);
      if (const double share = skin.dual_share.empty() ? 0 : skin.dual_share[i]; share > 0) {
        const auto row = static_cast<std::size_t>(skin.start[i]);
        const std::size_t count = static_cast<std::size_t>(skin.start[i + 1]) - row;
        const Vec3 turned = dual_blend(parts, std::span(skin.binding).subspan(row, count),
                                       std::span(skin.weight).subspan(row, count), positions[i]);
        sum = share < 1 ? Vec3((1 - share) * sum + share * turned) : turned;
      }
      positions[i] = sum;
    }
  });
}

}  // namespace ft::inline io

// Builds the body: capsules on the bones, blended by a smooth union (log-sum-exp), polygonised, relaxed to even
// triangles, and skinned by letting "nearest bone" diffuse over the surface - along the skin, so that nothing leaks
// from leg to leg or from arm to side through the air.
#include "io/import/body/body.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "baker/core/mesh.h"
#include "baker/core/parallel.h"
#include "io/import/body/bind.h"
#include "io/import/body/body_bones.h"
#include "io/import/body/surface_nets.h"
#include "io/import/character/pose.h"

namespace ft::inline io {
namespace {

constexpr double k_spacing = 0.0100;  ///< grid, share of the height: 16 mm on an adult
constexpr double k_blend = 0.007;     ///< width of the smooth union, share of the height
constexpr int k_relaxations = 12;
constexpr int k_diffusions = 18;  ///< spreads weights over about 4 cm to each side of a joint
constexpr std::size_t k_most_influences = 6;

/// Bones whose term in the field can matter within `reach` of a point.
std::vector<BodyBone> bones_near(const std::vector<BodyBone>& bones, const Vec3& p, double reach) {
  std::vector<BodyBone> out;
  for (const BodyBone& bone : bones)
    if (capsule_distance(bone, p) < 8 * k_blend + 2 * reach) out.push_back(bone);
  return out;
}

/// -k log sum exp(-d / k): below the smallest distance, smooth where several are near.
double field(const std::vector<BodyBone>& bones, const Vec3& p) {
  double sum = 0;
  for (const BodyBone& bone : bones)
    if (const double d = capsule_distance(bone, p); d < 8 * k_blend) sum += std::exp(-d / k_blend);
  return sum > 0 ? -k_blend * std::log(sum) : 8 * k_blend;
}

Vec3 gradient(const std::vector<BodyBone>& bones, const Vec3& p) {
  constexpr double e = 1e-4;
  Vec3 g;
  for (int k = 0; k < 3; ++k)
    g[k] = (field(bones, p + e * Vec3::Unit(k)) - field(bones, p - e * Vec3::Unit(k))) / (2 * e);
  return g;
}

FieldGrid sample_field(const std::vector<BodyBone>& bones, double spacing) {
  Box box;
  for (const BodyBone& bone : bones) {
    const double r = std::max(bone.radius_a, bone.radius_b);
    box.include(bone.a - Vec3::Constant(r)), box.include(bone.a + Vec3::Constant(r));
    box.include(bone.b - Vec3::Constant(r)), box.include(bone.b + Vec3::Constant(r));
  }
  box.inflate(4 * spacing + 4 * k_blend);
  FieldGrid grid;
  grid.origin = box.lo, grid.spacing = spacing;
  const Vec3 size = box.size() / spacing;
  grid.nx = static_cast<int>(std::ceil(size.x())) + 1, grid.ny = static_cast<int>(std::ceil(size.y())) + 1,
  grid.nz = static_cast<int>(std::ceil(size.z())) + 1;
  grid.values.assign(
      static_cast<std::size_t>(grid.nx) * static_cast<std::size_t>(grid.ny) * static_cast<std::size_t>(grid.nz), 0);
  // Each bone adds its term near itself only; further out it would add less than exp(-8).
  for (const BodyBone& bone : bones) {
    const double reach = std::max(bone.radius_a, bone.radius_b) + 8 * k_blend;
    const Vec3 lo = (bone.a.cwiseMin(bone.b).array() - reach - box.lo.array()) / spacing,
               hi = (bone.a.cwiseMax(bone.b).array() + reach - box.lo.array()) / spacing;
    const auto first = [&](int k) { return std::max(0, static_cast<int>(std::floor(lo[k]))); };
    const int ends[3] = {grid.nx, grid.ny, grid.nz};
    const auto last = [&](int k) { return std::min(ends[k] - 1, static_cast<int>(std::ceil(hi[k]))); };
    for (int z = first(2); z <= last(2); ++z)
      for (int y = first(1); y <= last(1); ++y)
        for (int x = first(0); x <= last(0); ++x)
          if (const double d = capsule_distance(bone, grid.point(x, y, z)); d < 8 * k_blend)
            grid.values[grid.index(x, y, z)] += std::exp(-d / k_blend);
  }
  for (double& v : grid.values) v = v > 0 ? -k_blend * std::log(v) : 8 * k_blend;
  return grid;
}

std::vector<std::vector<int>> neighbours(std::size_t count, const std::vector<std::array<int, 4>>& quads) {
  std::vector<std::vector<int>> out(count);
  for (const auto& q : quads)
    for (std::size_t k = 0; k < 4; ++k) {
      out[static_cast<std::size_t>(q[k])].push_back(q[(k + 1) % 4]);
      out[static_cast<std::size_t>(q[(k + 1) % 4])].push_back(q[k]);
    }
  for (auto& row : out) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  }
  return out;
}

/// Moves vertices along the surface towards their neighbours' middle, and back onto the surface.
void relax(const std::vector<BodyBone>& bones, const std::vector<std::vector<int>>& around,
           std::vector<Vec3>& positions) {
  std::vector<Vec3> next(positions.size());
  std::vector<std::vector<BodyBone>> near(positions.size());  // vertices wander by less than three cells
  parallel_for(positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) near[i] = bones_near(bones, positions[i], 3 * k_spacing);
  });
  for (int round = 0; round < k_relaxations; ++round) {
    parallel_for(positions.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Vec3 middle = Vec3::Zero();
        for (const int n : around[i]) middle += positions[static_cast<std::size_t>(n)];
        middle /= static_cast<double>(around[i].size());
        Vec3 p = positions[i] + 0.6 * (middle - positions[i]);
        const Vec3 g = gradient(near[i], p);
        const double squared = g.squaredNorm();
        if (squared > 0.05) p -= std::clamp(field(near[i], p), -k_spacing, k_spacing) / squared * g;
        next[i] = p;
      }
    });
    positions.swap(next);
  }
}

bool is_closed(const std::vector<Triangle>& triangles) {
  std::vector<std::array<int, 2>> edges;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i] == edges[i - 1]) return false;
    if (!std::binary_search(edges.begin(), edges.end(), std::array<int, 2>{edges[i][1], edges[i][0]})) return false;
  }
  return !edges.empty();
}

std::vector<Triangle> split(const std::vector<std::array<int, 4>>& quads, const std::vector<Vec3>& p) {
  std::vector<Triangle> out;
  const auto at = [&](int v) -> const Vec3& { return p[static_cast<std::size_t>(v)]; };
  for (const auto& q : quads) {
    if ((at(q[0]) - at(q[2])).squaredNorm() <= (at(q[1]) - at(q[3])).squaredNorm())
      out.push_back({q[0], q[1], q[2]}), out.push_back({q[0], q[2], q[3]});
    else
      out.push_back({q[0], q[1], q[3]}), out.push_back({q[1], q[2], q[3]});
  }
  return out;
}

/// Weights of bones on vertices: all on the nearest, then spread over the surface.
void skin_by_diffusion(const std::vector<BodyBone>& bones, const std::vector<std::vector<int>>& around,
                       const std::vector<Vec3>& positions, const std::vector<int>& column_of_bone, int columns,
                       CharacterMesh& mesh) {
  const auto width = static_cast<std::size_t>(columns);
  std::vector<float> weights(positions.size() * width, 0), next(weights.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < bones.size(); ++b)
      if (const double d = capsule_distance(bones[b], positions[i]); d < least) least = d, best = b;
    weights[i * width + static_cast<std::size_t>(column_of_bone[best])] = 1;
  }
  for (int round = 0; round < k_diffusions; ++round) {
    parallel_for(positions.size(), 512, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        float* row = next.data() + i * width;
        const float share = 0.7f / static_cast<float>(around[i].size());
        for (std::size_t k = 0; k < width; ++k) row[k] = 0.3f * weights[i * width + k];
        for (const int n : around[i])
          for (std::size_t k = 0; k < width; ++k) row[k] += share * weights[static_cast<std::size_t>(n) * width + k];
      }
    });
    weights.swap(next);
  }
  mesh.influence_start = {0};
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::vector<std::pair<float, int>> row;
    for (std::size_t k = 0; k < width; ++k)
      if (weights[i * width + k] > 0.01f) row.push_back({-weights[i * width + k], static_cast<int>(k)});
    std::sort(row.begin(), row.end());
    if (row.size() > k_most_influences) row.resize(k_most_influences);
    double sum = 0;
    for (const auto& entry : row) sum -= static_cast<double>(entry.first);
    std::sort(row.begin(), row.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const auto& [minus_weight, k] : row) {
      mesh.influence_bone.push_back(k);
      mesh.influence_weight.push_back(std::min(1.0, static_cast<double>(-minus_weight) / sum));
    }
    mesh.influence_start.push_back(static_cast<int>(mesh.influence_bone.size()));
  }
}

/// Columns of the weight table: one per node that a bone moves with; they become the mesh's bones.
std::vector<int> add_bones(const BodyFrame& frame, const std::vector<BodyBone>& bones, CharacterMesh& mesh) {
  std::vector<int> column(frame.globals.size(), -1), out;
  for (const BodyBone& bone : bones) {
    int& c = column[static_cast<std::size_t>(bone.node)];
    if (c < 0) {
      c = static_cast<int>(mesh.bones.size());
      mesh.bones.push_back({bone.node, frame.globals[static_cast<std::size_t>(bone.node)].inverse()});
    }
    out.push_back(c);
  }
  return out;
}

bool is_one_piece(const std::vector<std::vector<int>>& around) {
  std::vector<char> seen(around.size(), 0);
  std::vector<int> stack{0};
  std::size_t count = 0;
  for (seen[0] = 1; !stack.empty(); ++count) {
    const int v = stack.back();
    stack.pop_back();
    for (const int n : around[at(v)])
      if (!seen[at(n)]) seen[at(n)] = 1, stack.push_back(n);
  }
  return count == around.size();
}

Status add_blended(const Character& character, const BodyFrame& frame, CharacterMesh& mesh) {
  std::vector<BodyBone> bones = flesh(character, frame);
  if (bones.empty()) return input_error("no body can be built: the skeleton has no bones");
  bool linked = false;
  for (const double spacing : {1.0, 1.0, 0.93, 1.08, 0.85}) {
    FieldGrid grid = sample_field(bones, spacing * k_spacing);
    separate_sheets(grid);
    const NetSurface net = surface_nets(grid);
    std::vector<Vec3> positions = net.positions;
    if (positions.empty()) continue;
    const auto around = neighbours(positions.size(), net.quads);
    if (!is_one_piece(around)) {
      const std::vector<BodyBone> more = links(frame);
      if (!linked) bones.insert(bones.end(), more.begin(), more.end());
      linked = true;
      continue;
    }
    relax(bones, around, positions);
    mesh.triangles = split(net.quads, positions);
    if (!is_closed(mesh.triangles)) continue;
    const std::vector<int> columns = add_bones(frame, bones, mesh);
    skin_by_diffusion(bones, around, positions, columns, static_cast<int>(mesh.bones.size()), mesh);
    mesh.positions = std::move(positions);
    return {};
  }
  return input_error("no closed body in one piece can be built from the skeleton", "", "try body = \"capsules\"");
}

void add_capsule(const BodyBone& bone, int column, CharacterMesh& mesh) {
  constexpr int k_around = 20, k_rings = 6;  // rings of each cap
  Vec3 axis = bone.b - bone.a;
  axis = axis.norm() > 1e-9 ? axis.normalized() : Vec3::UnitY().eval();
  const Vec3 u = axis.unitOrthogonal(), v = axis.cross(u);
  const int first = static_cast<int>(mesh.positions.size());
  mesh.positions.push_back(bone.a - bone.radius_a * axis);
  for (int ring = 1; ring <= 2 * k_rings; ++ring) {
    const bool lower = ring <= k_rings;
    const double angle = M_PI / 2 * (lower ? ring - k_rings : ring - k_rings - 1) / k_rings;
    const double r = lower ? bone.radius_a : bone.radius_b;
    for (int k = 0; k < k_around; ++k) {
      const double turn = 2 * M_PI * k / k_around;
      mesh.positions.push_back((lower ? bone.a : bone.b) + r * std::sin(angle) * axis +
                               r * std::cos(angle) * (std::cos(turn) * u + std::sin(turn) * v));
    }
  }
  const int last = static_cast<int>(mesh.positions.size());
  mesh.positions.push_back(bone.b + bone.radius_b * axis);
  for (int k = 0; k < k_around; ++k) {
    const int next = (k + 1) % k_around;
    mesh.triangles.push_back({first, first + 1 + next, first + 1 + k});
    for (int ring = 0; ring + 1 < 2 * k_rings; ++ring) {
      const int a = first + 1 + ring * k_around;
      mesh.triangles.push_back({a + k, a + next, a + k_around + next});
      mesh.triangles.push_back({a + k, a + k_around + next, a + k_around + k});
    }
    const int top = last - k_around;
    mesh.triangles.push_back({last, top + k, top + next});
  }
  while (static_cast<int>(mesh.influence_bone.size()) <= last) {
    mesh.influence_bone.push_back(column);
    mesh.influence_weight.push_back(1);
    mesh.influence_start.push_back(static_cast<int>(mesh.influence_bone.size()));
  }
}

Status add_capsules(const Character& character, const BodyFrame& frame, CharacterMesh& mesh) {
  const std::vector<BodyBone> bones = capsules(character, frame);
  if (bones.empty()) return input_error("no body can be built: the skeleton has no bones");
  const std::vector<int> columns = add_bones(frame, bones, mesh);
  mesh.influence_start = {0};
  for (std::size_t b = 0; b < bones.size(); ++b) add_capsule(bones[b], columns[b], mesh);
  return {};
}

}  // namespace

Status add_body(Character& character, const std::string& style, const Mat3& axes, std::span<const Mat4> globals) {
  const std::vector<Mat4> rest = rest_globals(character.nodes);
  if (globals.empty()) globals = rest;
  std::vector<CharacterMesh> meshes;
  std::vector<std::pair<std::string, Error>> bare;  // roots without a body, and why
  bool arms_raised = false, legs_parted = false;
  for (int root = 0; root < static_cast<int>(rest.size()); ++root) {
    if (character.nodes[at(root)].parent >= 0) continue;
    auto frame = body_frame(character, root, axes, globals);
    CharacterMesh mesh;
    Status built = !frame                ? Status(frame.error())
                   : style == "capsules" ? add_capsules(character, *frame, mesh)
                                         : add_blended(character, *frame, mesh);
    if (!built) {
      bare.emplace_back(character.nodes[at(root)].name, built.error());
      continue;
    }
    const Mat3 back = axes.transpose() / frame->scale;
    for (Vec3& p : mesh.positions) p = back * p;
    arms_raised = arms_raised || frame->arms_raised, legs_parted = legs_parted || frame->legs_parted;
    meshes.push_back(std::move(mesh));
  }
  if (meshes.empty()) return bare.empty() ? input_error("has no skeleton") : bare.front().second;
  for (const auto& [name, fault] : bare)
    character.notes.push_back("no body was built around \"" + name + "\": " + fault.what);
  if (arms_raised)
    character.notes.emplace_back(
        "arms hang in the rest pose; the body, and what it wears, is modelled with arms raised");
  if (legs_parted)
    character.notes.emplace_back("legs are close together in the rest pose; the body is modelled with them apart");
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    meshes[k].name = meshes.size() == 1 ? "body" : "body_" + std::to_string(k + 1);
    meshes[k].node = static_cast<int>(character.nodes.size());
    character.nodes.push_back({meshes[k].name, -1, Mat4::Identity(), {}});
    character.meshes.push_back(std::move(meshes[k]));
  }
  return {};
}

}  // namespace ft::inline io

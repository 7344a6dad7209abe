// See creases.h.
#include "collision/body/creases.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"
#include "baker/core/rigid.h"

namespace ft::inline collision {
namespace {

constexpr std::size_t k_block = 1024;
constexpr std::size_t k_samples = 256;  ///< vertices that tell how a part moves, about
/// A joint that folds a part back onto the other has no plane between them: |sum of both axes| below this [1].
constexpr double k_folded = 1e-3;
constexpr double k_content = 1e-9;  ///< missing distance that is not worth a push [m]

Vec3 mean(std::span<const Vec3> x) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : x) sum += p;
  return x.empty() ? sum : (sum / static_cast<double>(x.size())).eval();
}

}  // namespace

Creases::Creases(const PartSurface& surface, std::span<const SurfacePart> parts, std::span<const int> part_of_vertex,
                 std::span<const Vec3> bind, double gap)
    : surface_(&surface), gap_(gap), parts_(parts.size()) {
  const auto representative = surface.representative();
  for (int v = 0; v < static_cast<int>(representative.size()); ++v) {
    if (representative[at(v)] != v) continue;
    Part& part = parts_[at(part_of_vertex[at(v)])];
    part.vertices.push_back(v);
    part.bind.push_back(bind[at(v)]);
  }
  for (Part& part : parts_)
    for (std::size_t i = 0; i < part.bind.size(); i += 1 + part.bind.size() / k_samples) {
      part.samples.push_back(part.vertices[i]);
      part.sample_bind.push_back(part.bind[i]);
    }
  for (int child = 0; child < static_cast<int>(parts.size()); ++child) {
    const int parent = parts[at(child)].parent;
    if (parent < 0 || parts[at(child)].sheet || parts[at(parent)].sheet) continue;
    if (!parts[at(child)].folds || surface.tree(child).empty() || surface.tree(parent).empty()) continue;
    const double thickness = std::max(surface.half_thickness(child), surface.half_thickness(parent));
    Joint joint{{parent, child}, Vec3::Zero(), Vec3::Zero(), {}, 2 * thickness + gap};
    int touching_sides = 0;
    for (int side = 0; side < 2; ++side) {
      const Part& own = parts_[at(joint.part[side])];
      joint.keep[side] = distances_to(joint.part[1 - side], own, bind, joint.reach);
      std::vector<Vec3> touching;
      for (std::size_t i = 0; i < own.bind.size(); ++i)
        if (joint.keep[side][i] < gap) touching.push_back(own.bind[i]);
      joint.place += mean(touching);
      touching_sides += touching.empty() ? 0 : 1;
    }
    if (touching_sides == 0) continue;
    joint.place /= touching_sides;
    joint.axis = (mean(parts_[at(child)].sample_bind) - mean(parts_[at(parent)].sample_bind)).normalized();
    for (int side = 0; side < 2; ++side)
      for (std::size_t i = 0; i < joint.keep[side].size(); ++i) {
        const Vec3& p = parts_[at(joint.part[side])].bind[i];
        const double on_own_side = (side == 0 ? -1 : 1) * (p - joint.place).dot(joint.axis);
        double& keep = joint.keep[side][i];
        keep = std::min({0.5 * gap, keep - thickness, on_own_side});
      }
    joints_.push_back(std::move(joint));
  }
}

/// Signed distances of a part's vertices from another part in the bind pose; what is farther than reach is there [m].
std::vector<double> Creases::distances_to(int other, const Part& own, std::span<const Vec3> bind, double reach) const {
  const std::vector<char> all_allowed(parts_.size(), 1);
  std::vector<double> out(own.bind.size(), reach);
  parallel_for(out.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      TriangleTree::Hit hit;
      hit.closest.squared_distance = reach * reach;
      surface_->tree(other).closest(own.bind[i], bind, surface_->triangles(), hit);
      if (hit.triangle < 0) continue;
      const auto answer = surface_->judge(own.bind[i], hit, all_allowed, bind);
      out[i] = answer ? answer->distance : std::sqrt(hit.closest.squared_distance);
    }
  });
  return out;
}

void Creases::push_apart(const Joint& joint, const Eigen::Isometry3d moves[2], std::span<const Vec3> drawn,
                         std::vector<TriangleTree>& trees, std::span<Vec3> positions) const {
  const Vec3 sum = moves[0].linear() * joint.axis + moves[1].linear() * joint.axis;
  if (sum.norm() < k_folded) return;
  const Vec3 axis = sum.normalized(), place = 0.5 * (moves[0] * joint.place + moves[1] * joint.place);
  for (int side = 0; side < 2; ++side) {
    const Part& own = parts_[at(joint.part[side])];
    const int other = joint.part[1 - side];
    const Vec3 own_way = side == 0 ? (-axis).eval() : axis;
    std::vector<std::size_t> beyond;
    for (std::size_t i = 0; i < own.vertices.size(); ++i)
      if ((drawn[at(own.vertices[i])] - place).dot(own_way) < joint.keep[side][i]) beyond.push_back(i);
    if (beyond.empty()) continue;
    TriangleTree& tree = trees[at(other)];
    if (tree.empty()) {
      tree = surface_->tree(other);
      tree.refit(drawn, surface_->triangles());
    }
    parallel_for(beyond.size(), k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const int v = own.vertices[beyond[k]];
        const Vec3& p = drawn[at(v)];
        // The other part's skin as seen from this one's: in front of the vertex, or behind it by so much as they
        // overlap. Where it is not, there is room.
        const double ahead =
            tree.ray(p + joint.reach * own_way, -own_way, 2 * joint.reach, -1, drawn, surface_->triangles()) -
            joint.reach;
        const double missing = joint.keep[side][beyond[k]] - (p - place).dot(own_way);
        const double move = std::min(missing, gap_ - ahead);
        if (move > k_content) positions[at(v)] += move * own_way;
      }
    });
  }
}

void Creases::open(std::span<Vec3> positions) const {
  if (joints_.empty()) return;
  const std::vector<Vec3> drawn(positions.begin(), positions.end());
  std::vector<Eigen::Isometry3d> moves(parts_.size());
  parallel_tasks(parts_.size(), [&](std::size_t p) {
    std::vector<Vec3> now;
    now.reserve(parts_[p].samples.size());
    for (const int v : parts_[p].samples) now.push_back(drawn[at(v)]);
    moves[p] = rigid_fit(parts_[p].sample_bind, now);
  });
  std::vector<TriangleTree> trees(parts_.size());
  for (const Joint& joint : joints_) {
    const Eigen::Isometry3d both[2] = {moves[at(joint.part[0])], moves[at(joint.part[1])]};
    push_apart(joint, both, drawn, trees, positions);
  }
}

}  // namespace ft::inline collision

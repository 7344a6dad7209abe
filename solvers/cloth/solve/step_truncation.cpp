#include "solvers/cloth/solve/step_truncation.h"

#include <algorithm>
#include <set>
#include <utility>

#include "baker/core/give_back.h"
#include "baker/core/parallel.h"
#include "collision/step_bound/truncate_dat.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 512;  ///< of a loop over vertices
/// Distance that truncation always keeps [m].
constexpr double k_floor = 1e-5;
/// Of the way from a cluster's mean to its farthest vertex, or of a cap's height, now or at rest, that one iteration
/// may turn or stretch it by: they are stiff springs of next to no length, whose directions change with every step.
constexpr double k_most_turned = 0.5;

double farthest_from(const Vec3& place, std::span<const int> vertices, std::span<const Vec3> x) {
  double farthest = 0;
  for (const int v : vertices) farthest = std::max(farthest, (x[at(v)] - place).norm());
  return farthest;
}

}  // namespace

StepTruncation::StepTruncation(const ClothModel& model) : model_(model) {
  const std::span<const Vec3> rest = model.contact.rest;
  std::set<std::pair<int, Edge>> flipped;  // no springs
  for (const FlippedCap& cap : model.flipped_caps) flipped.emplace(cap.vertex, cap.base);
  for (const Triangle& t : model.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[(k + 1) % 3], t[(k + 2) % 3]);
      const Edge base{low, high};
      const Vec3 along = rest[at(base[1])] - rest[at(base[0])], up = rest[at(t[k])] - rest[at(base[0])];
      const double length = along.norm(), way = length > 0 ? up.dot(along) / length : 0;
      const double height = (up - way / length * along).norm();
      const int cluster = model.clusters.of(t[k]);
      const bool together =
          cluster >= 0 && (cluster == model.clusters.of(base[0]) || cluster == model.clusters.of(base[1]));
      if (height <= k_very_near * model.typical_edge[at(model.contact.garment[at(t[k])])] && way > 0 && way < length &&
          !together && !flipped.contains({t[k], base}))
        caps_.push_back({t[k], base, way / length, height});
    }
}

void StepTruncation::damp_relative_motion(std::span<const Vec3> all, std::span<Vec3> direction) const {
  const VertexClusters& clusters = model_.clusters;
  const std::span<const Vec3> rest = model_.contact.rest;
  for (int c = 0; c < clusters.count(); ++c) {
    const std::span<const int> members = clusters.members(c);
    const Vec3 mean = clusters.mean(c, direction);
    const double extent = std::max(farthest_from(clusters.mean(c, all), members, all),
                                   farthest_from(clusters.mean(c, rest), members, rest));
    const double farthest = farthest_from(mean, members, direction), most = k_most_turned * extent;
    if (farthest <= most) continue;
    for (const int v : members) direction[at(v)] = mean + most / farthest * (direction[at(v)] - mean);
  }
  for (const Cap& cap : caps_) {
    const auto on_base = [&](std::span<const Vec3> x) -> Vec3 {
      return (1 - cap.place) * x[at(cap.base[0])] + cap.place * x[at(cap.base[1])];
    };
    const Vec3 base = on_base(direction), against = direction[at(cap.vertex)] - base;
    const double height = (all[at(cap.vertex)] - on_base(all)).norm();
    const double most = k_most_turned * std::max(height, cap.height);
    if (against.norm() > most) direction[at(cap.vertex)] = base + most / against.norm() * against;
  }
}

void StepTruncation::truncate(ContactPotential& contact, std::span<const Vec3> all, const MotionBounds& balls,
                              const PairsSuffice& pairs_suffice, std::span<Vec3> direction, std::span<Vec3> cut,
                              std::span<Vec3> trial) {
  const std::size_t n = direction.size();
  share_.resize(n);
  length_.resize(n);
  parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      share_[i] = share_inside_ball(all[i] - balls.centre_of(i), direction[i], balls.radius[i]);
  });
  model_.clusters.take_least(share_);
  parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      direction[i] *= share_[i];
      length_[i] = direction[i].norm();
    }
  });
  model_.clusters.take_most(length_);
  do {
    contact.near_pairs(length_, k_floor, near_);
    const std::span<Vec3> common = cut;  // until the rest is added
    common_motion_.find(all, direction, model_.vertex_count(), near_, k_floor, balls, model_.clusters, common);
    truncate_displacements(all, direction, common, model_.vertex_count(), near_, k_floor, share_);
    model_.clusters.take_least(share_);
    parallel_for(n, k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        cut[i] = common[i] + share_[i] * (direction[i] - common[i]);
        trial[i] = all[i] + cut[i];
      }
    });
  } while (pairs_suffice && !pairs_suffice(trial.first(n)));
  give_back(share_, length_, near_.vertex_face, near_.edge_edge);
}

std::vector<PairObstacle> StepTruncation::obstacles(ContactPotential& contact, std::span<const Vec3> all,
                                                    std::span<const Vec3> direction) {
  length_.resize(direction.size());
  for (std::size_t i = 0; i < direction.size(); ++i) length_[i] = direction[i].norm();
  contact.near_pairs(length_, k_floor, near_);
  std::vector<PairObstacle> out = find_obstacles(all, direction, model_.vertex_count(), near_, k_floor);
  give_back(length_, near_.vertex_face, near_.edge_edge);
  return out;
}

}  // namespace ft::inline solvers

#include "solvers/cloth/model/moving_collider.h"

#include <algorithm>
#include <cmath>

#include "baker/core/smooth_step.h"
#include "collision/check/crossings.h"
#include "collision/check/penetration.h"

namespace ft::inline solvers {
namespace {

/// Garments deeper inside than this are not pushed out but let through and reported [m].
constexpr double k_deepest_start = 0.03;

}  // namespace

MovingCollider::MovingCollider(std::shared_ptr<const FeasiblePoses> poses) : poses_(std::move(poses)) {
  const auto& parts = trajectory().surface().parts;
  has_sheets_ = ft::has_sheets(parts);
  if (has_sheets_) {
    solid_ = ft::solid_triangles(triangles(), part_of_vertex(), parts);
    solid_drawn_ = ft::solid_triangles(trajectory().surface().triangles, trajectory().surface().part_of_vertex, parts);
  }
}

double MovingCollider::inset_share(double time) const {
  const double preroll = trajectory().preroll();
  if (preroll <= 0) return 0;
  return 1 - smooth_step((time + preroll) / (0.6 * preroll));
}

double MovingCollider::draw_in_for(std::span<const Vec3> points, std::span<const Triangle> cloth, double clearance) {
  inset_.clear();
  if (trajectory().preroll() <= 0) return 0;
  std::vector<Vec3> pose, full;
  drawn(-trajectory().preroll(), pose);
  feasible(-trajectory().preroll(), pose, full);
  std::vector<double> inset(full.size(), 0.0);
  double deepest = 0;
  // First guess: each collider vertex gives way by what the points inside near it need, less with the distance.
  const double reach = 0.06;
  for (const Penetration& p : penetrations(points, full, solid_triangles())) {
    deepest = std::max(deepest, p.depth);
    const double need = std::min(p.depth, k_deepest_start) + clearance;
    for (std::size_t v = 0; v < full.size(); ++v) {
      const double d = (full[v] - points[at(p.vertex)]).norm();
      if (d < reach) inset[v] = std::max(inset[v], need * std::min(1.0, 1.5 * (1 - d / reach)));
    }
  }
  // What still crosses (a body vertex through a cloth face) gives way in small steps, its neighbours with it.
  const std::vector<Edge> edges = unique_edges(solid_triangles());
  const std::vector<Vec3> normals = vertex_normals(full, solid_triangles());
  std::vector<Vec3> surface(full.size());
  for (int round = 0; round < 24; ++round) {
    for (std::size_t v = 0; v < full.size(); ++v) surface[v] = full[v] - inset[v] * normals[v];
    std::vector<char> blocked(full.size(), 0);
    const auto crossing = crossings_between(points, cloth, surface, solid_triangles());
    if (crossing.empty()) break;
    for (const Crossing& c : crossing) {
      if (c.edge_of_first)
        for (const int v : c.triangle) blocked[at(v)] = 1;
      else
        for (const int v : c.edge) blocked[at(v)] = 1;
    }
    for (std::size_t v = 0; v < inset.size(); ++v)
      if (blocked[v]) inset[v] = std::min(inset[v] + 2e-3, k_deepest_start + clearance);
    const std::vector<double> before = inset;
    for (const Edge& e : edges)
      for (int k = 0; k < 2; ++k) inset[at(e[at(k)])] = std::max(inset[at(e[at(k)])], 0.8 * before[at(e[at(1 - k)])]);
  }
  inset_ = std::move(inset);
  largest_inset_ = inset_.empty() ? 0 : *std::max_element(inset_.begin(), inset_.end());
  if (largest_inset_ == 0) inset_.clear();
  return deepest;
}

void MovingCollider::refined_bind(std::span<Vec3> positions) const {
  poses_->collider().refine(bind_pose_of(trajectory()), positions);
}

void MovingCollider::drawn(double time, std::vector<Vec3>& positions) const {
  positions.resize(at(trajectory().surface().vertex_count()));
  trajectory().sample(time, positions);
}

std::vector<Vec3> MovingCollider::refined(double time) const {
  std::vector<Vec3> pose, out(at(vertex_count()));
  drawn(time, pose);
  poses_->collider().refine(pose, out);
  return out;
}

CarveReport MovingCollider::feasible(double time, std::span<const Vec3> drawn, std::vector<Vec3>& positions,
                                     std::vector<char>* absent) const {
  positions.resize(at(vertex_count()));
  if (absent != nullptr) absent->resize(positions.size());
  const CarveReport report =
      poses_->evaluate(time, drawn, positions, absent != nullptr ? std::span<char>(*absent) : std::span<char>());
  const double share = inset_.empty() ? 0 : inset_share(time);
  if (share > 0) {
    const std::vector<Vec3> normals = vertex_normals(positions, triangles());
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] -= (share * inset_[v]) * normals[v];
  }
  return report;
}

}  // namespace ft::inline solvers

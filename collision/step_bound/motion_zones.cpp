#include "collision/step_bound/motion_zones.h"

namespace ft::inline collision {

void MotionZones::clear(int cloth_vertex_count, const VertexClusters& clusters) {
  zones_.reset(at(cloth_vertex_count));
  for (int c = 0; c < clusters.count(); ++c)
    for (const int v : clusters.members(c)) zones_.join(clusters.members(c).front(), v);
  body_.clear();
}

void MotionZones::join(PairKind kind, const Stencil& stencil, const std::array<Vec3, 4>& x,
                       const std::array<Vec3, 4>& d) {
  const int n = static_cast<int>(zones_.count());
  int first = -1;
  for (const int v : stencil.v)
    if (v < n) first = zones_.join(first < 0 ? v : first, v);
  if (first < 0) return;
  const PairGeometry g = pair_geometry(kind, x);
  Vec3 motion = Vec3::Zero();
  double weight = 0;
  int body_vertex = -1;
  for (std::size_t k = 0; k < 4; ++k) {
    if (stencil.v[k] < n) continue;
    body_vertex = stencil.v[k];
    motion += std::abs(g.weight[k]) * d[k], weight += std::abs(g.weight[k]);
  }
  if (weight > 0) body_.push_back({first, body_vertex, motion / weight});
}

void MotionZones::apply(std::span<Vec3> motion) const {
  struct Sum {
    Vec3 body = Vec3::Zero(), own = Vec3::Zero();
    int contacts = 0, vertices = 0;
  };
  std::vector<Sum> sums(zones_.count());
  std::vector<int> roots(zones_.count());
  for (std::size_t v = 0; v < roots.size(); ++v) {
    roots[v] = root(static_cast<int>(v));
    Sum& s = sums[at(roots[v])];
    s.own += motion[v];
    ++s.vertices;
  }
  for (const BodyMotion& b : body_) {
    Sum& s = sums[at(roots[at(b.vertex)])];
    s.body += b.motion;
    ++s.contacts;
  }
  for (std::size_t v = 0; v < roots.size(); ++v) {
    const Sum& s = sums[at(roots[v])];
    if (s.contacts > 0)
      motion[v] = s.body / s.contacts;
    else if (s.vertices > 1)
      motion[v] = s.own / s.vertices;
  }
}

}  // namespace ft::inline collision

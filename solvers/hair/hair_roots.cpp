#include "solvers/hair/hair_roots.h"

#include <cmath>

#include "collision/geometry/pair_geometry.h"
#include "collision/geometry/triangle_tree.h"

namespace ft::inline solvers {

HairRoots::HairRoots(const Trajectory& scalp, std::span<const Vec3> roots) {
  const std::vector<Vec3> bind = bind_pose_of(scalp);
  const auto& triangles = scalp.surface().triangles;
  const TriangleTree tree(bind, triangles);
  for (const Vec3& root : roots) {
    TriangleTree::Hit hit;
    tree.closest(root, bind, triangles, hit);
    const Triangle& t = triangles[at(hit.triangle)];
    const Vec3 &a = bind[at(t[0])], &b = bind[at(t[1])], &c = bind[at(t[2])];
    const PairGeometry g = vertex_face_geometry(root, a, b, c);
    const Vec3 weights(-g.weight[1], -g.weight[2], -g.weight[3]);
    const Vec3 place = weights[0] * a + weights[1] * b + weights[2] * c;
    const Mat3 turn = triangle_frame(a, b, c);
    roots_.push_back({t, weights, turn.transpose() * (root - place)});
    farthest_ = std::max(farthest_, (root - place).norm());
  }
  frames(bind, bind_);
}

void HairRoots::frames(std::span<const Vec3> scalp, std::vector<RootFrame>& out) const {
  out.resize(roots_.size());
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    const Root& r = roots_[i];
    const Vec3 &a = scalp[at(r.corners[0])], &b = scalp[at(r.corners[1])], &c = scalp[at(r.corners[2])];
    out[i].turn = triangle_frame(a, b, c);
    out[i].place = r.weights[0] * a + r.weights[1] * b + r.weights[2] * c + out[i].turn * r.off;
  }
}

}  // namespace ft::inline solvers

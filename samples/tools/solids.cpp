#include "samples/tools/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ft::sets {
namespace {

/// A face of a convex solid about the origin, turned so that it is seen from outside.
void add_face(Mesh& mesh, std::vector<int> corners) {
  const auto p = [&](std::size_t k) -> const Vec3& { return mesh.positions[at(corners[k])]; };
  if ((p(1) - p(0)).cross(p(2) - p(1)).dot(p(0)) < 0) std::reverse(corners.begin(), corners.end());
  mesh.face_sizes.push_back(static_cast<int>(corners.size()));
  mesh.face_vertices.insert(mesh.face_vertices.end(), corners.begin(), corners.end());
}

}  // namespace

Mesh bevelled_box(const Vec3& size, double bevel) {
  // Corner c (bit k set: the upper end of axis k) has a vertex on each of its three faces.
  const auto vertex = [](int corner, int face_axis) { return 3 * corner + face_axis; };
  Mesh out;
  for (int corner = 0; corner < 8; ++corner)
    for (int face = 0; face < 3; ++face) {
      Vec3 p;
      for (int k = 0; k < 3; ++k) p[k] = (corner >> k & 1 ? 1 : -1) * (0.5 * size[k] - (k == face ? 0 : bevel));
      out.positions.push_back(p);
    }
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    for (const int on_a : {0, 1 << a}) {
      add_face(out, {vertex(on_a, a), vertex(on_a | 1 << b, a), vertex(on_a | 1 << b | 1 << c, a),
                     vertex(on_a | 1 << c, a)});
      for (const int on_b : {0, 1 << b}) {
        const int low = on_a | on_b, high = low | 1 << c;
        add_face(out, {vertex(low, a), vertex(high, a), vertex(high, b), vertex(low, b)});
      }
    }
  }
  for (int corner = 0; corner < 8; ++corner) add_face(out, {vertex(corner, 0), vertex(corner, 1), vertex(corner, 2)});
  return out;
}

Mesh rod(double length, double radius, int sides) {
  Mesh out;
  std::vector<int> low, high;
  for (int k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    for (const double y : {-0.5 * length, 0.5 * length})
      out.positions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    low.push_back(2 * k);
    high.push_back(2 * k + 1);
  }
  for (int k = 0; k < sides; ++k) {
    const int next = (k + 1) % sides;
    add_face(out, {2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
  }
  add_face(out, low);
  add_face(out, high);
  return out;
}

Eigen::Isometry3d between(const Vec3& from, const Vec3& to) {
  return Eigen::Translation3d(0.5 * (from + to)) * Quat::FromTwoVectors(Vec3::UnitY(), to - from);
}

void add(Mesh& to, const Mesh& solid, const Eigen::Isometry3d& place) {
  const int first = to.vertex_count();
  for (const Vec3& p : solid.positions) to.positions.push_back(place * p);
  to.face_sizes.insert(to.face_sizes.end(), solid.face_sizes.begin(), solid.face_sizes.end());
  for (const int v : solid.face_vertices) to.face_vertices.push_back(first + v);
}

}  // namespace ft::sets

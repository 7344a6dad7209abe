#include "baker/core/shapes.h"

#include <algorithm>
#include <map>

namespace ft {

TriangleSurface sphere_surface(double radius, int levels) {
  TriangleSurface out;
  out.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  out.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [known, is_new] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(out.positions.size()));
      if (is_new) out.positions.push_back((out.positions[at(a)] + out.positions[at(b)]).normalized());
      return known->second;
    };
    std::vector<Triangle> finer;
    for (const Triangle& t : out.triangles) {
      const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
    }
    out.triangles = std::move(finer);
  }
  for (Vec3& p : out.positions) p *= radius;
  return out;
}

TriangleSurface box_surface(const Vec3& size) {
  TriangleSurface out;
  for (int corner = 0; corner < 8; ++corner)
    out.positions.push_back(0.5 * Vec3(corner & 1 ? size.x() : -size.x(), corner & 2 ? size.y() : -size.y(),
                                       corner & 4 ? size.z() : -size.z()));
  out.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
  return out;
}

TriangleSurface capsule_surface(double radius, double length, int levels) {
  TriangleSurface out = sphere_surface(radius, levels);
  // The ring at the middle is doubled: its lower copy closes the lower half.
  const std::size_t sphere = out.positions.size();
  std::vector<int> lower(sphere);
  std::vector<int> ring;
  for (std::size_t i = 0; i < sphere; ++i) {
    lower[i] = static_cast<int>(i);
    if (std::abs(out.positions[i].y()) > 1e-9 * radius) continue;
    ring.push_back(static_cast<int>(i));
    lower[i] = static_cast<int>(out.positions.size());
    out.positions.push_back(out.positions[i]);
  }
  for (Triangle& t : out.triangles) {
    const double side = out.positions[at(t[0])].y() + out.positions[at(t[1])].y() + out.positions[at(t[2])].y();
    if (side < 0)
      for (int& v : t) v = lower[at(v)];
  }
  for (std::size_t i = 0; i < out.positions.size(); ++i) {
    Vec3& p = out.positions[i];
    const bool below = i >= sphere || p.y() < -1e-9 * radius;
    p.y() += below ? -0.5 * length : 0.5 * length;
  }
  std::sort(ring.begin(), ring.end(), [&](int a, int b) {
    const auto angle = [&](int v) { return std::atan2(out.positions[at(v)].z(), out.positions[at(v)].x()); };
    return angle(a) < angle(b);
  });
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const int a = ring[i], b = ring[(i + 1) % ring.size()];
    out.triangles.push_back({a, b, lower[at(b)]});
    out.triangles.push_back({a, lower[at(b)], lower[at(a)]});
  }
  return out;
}

}  // namespace ft

#include "solvers/cloth/advance/substep_count.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "baker/core/parallel.h"

namespace ft::inline solvers {
namespace {

/// What the ends of an edge may move against each other in one substep, by its length at rest (of all edges, see
/// turning()): cloth that whips about turns and strains by as much, and Newton's method starts that far from the
/// answer.
constexpr double k_most_turn = 0.2;
/// What vertices may move against the mean motion of their garment in one substep, in its typical edges (see
/// scatter()): pairs that may meet grow with a power of it, and folds of fine cloth are cheaper in more and shorter
/// steps.
constexpr double k_most_scatter = 1.25;
/// What the body may move against the cloth in one substep, in the smallest typical edge of the garments: of fine cloth
/// it meets more with each contact radius of its way.
constexpr double k_most_way = 3.5;

/// Of single vertices, before they are slowed down.
constexpr double k_most_scatter_of_one = 4;

/// How fast the ends of the edges move against each other, by their lengths at rest; both root mean square [1/s], so
/// that an edge counts as much as the cloth that it is in, and tiny ones hardly.
double turning(const RestEdges& rest, const ClothMotion& m) {
  const Vec2 squares =
      parallel_sum(rest.edges.size(), 1024, Vec2(0, 0), [&](std::size_t begin, std::size_t end) -> Vec2 {
        Vec2 sum(0, 0);
        for (std::size_t k = begin; k < end; ++k) {
          const auto [a, b] = rest.edges[k];
          sum += Vec2((m.v[at(a)] - m.v[at(b)]).squaredNorm(), rest.lengths[k] * rest.lengths[k]);
        }
        return sum;
      });
  return squares[1] > 0 ? std::sqrt(squares[0] / squares[1]) : 0;
}

/// How fast the vertices of a garment move against its mean motion, by its typical edge; root mean square over all
/// garments [1/s]. What may meet in a step grows with it: folds of fine cloth that pass each other.
double scatter(const ClothModel& model, const ClothMotion& m) {
  double sum = 0;
  for (std::size_t g = 0; g + 1 < model.first_vertex.size(); ++g) {
    const auto first = at(model.first_vertex[g]), count = at(model.first_vertex[g + 1]) - first;
    const Vec3 total = parallel_sum(count, 1024, Vec3(0, 0, 0), [&](std::size_t begin, std::size_t end) -> Vec3 {
      Vec3 own(0, 0, 0);
      for (std::size_t i = first + begin; i < first + end; ++i) own += m.v[i];
      return own;
    });
    const Vec3 mean = total / static_cast<double>(std::max<std::size_t>(count, 1));
    sum += parallel_sum(count, 1024, 0.0,
                        [&](std::size_t begin, std::size_t end) {
                          double own = 0;
                          for (std::size_t i = first + begin; i < first + end; ++i)
                            own += (m.v[i] - mean).squaredNorm();
                          return own;
                        }) /
           (model.typical_edge[g] * model.typical_edge[g]);
  }
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(m.v.size(), 1)));
}

/// So many that the body moves no farther against the cloth in one than the setup says, nor than k_most_way.
double substeps_of_body(const ClothModel& model, const ClothMotion& m, double duration, std::span<const Vec3> body_t0,
                        std::span<const Vec3> body_t1, std::span<const char> deep_t0, std::span<const char> deep_t1) {
  const ClothSetup& setup = model.setup;
  if (body_t0.empty()) return 0;
  // Speed of the body relative to the cloth's own mean motion, where cloth is near.
  const double cell = 0.06;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : m.v) mean += v * (duration / static_cast<double>(m.v.size()));
  std::vector<std::array<int, 3>> cells;
  cells.reserve(m.x.size());
  const auto cell_of = [&](const Vec3& p) {
    return std::array<int, 3>{static_cast<int>(std::floor(p.x() / cell)), static_cast<int>(std::floor(p.y() / cell)),
                              static_cast<int>(std::floor(p.z() / cell))};
  };
  for (const Vec3& p : m.x) cells.push_back(cell_of(p));
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  const auto is_near = [&](const Vec3& from, const Vec3& way, double length) {
    // What starts before the cloth and ends behind it was near on its way.
    const int stops = 1 + static_cast<int>(std::min(length / cell, 256.0));
    for (int stop = 0; stop <= stops; ++stop) {
      const auto c = cell_of(from + (static_cast<double>(stop) / stops) * way);
      for (int k = 0; k < 27; ++k)
        if (std::binary_search(cells.begin(), cells.end(),
                               std::array<int, 3>{c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1}))
          return true;
    }
    return false;
  };
  double radius = 1e-3;
  for (const double r : model.contact.radius) radius = std::max(radius, r);
  double travel = setup.travel * radius;
  for (const double edge : model.typical_edge) travel = std::min(travel, k_most_way * edge);
  // The fastest first: the first that is near decides, and slow ones change nothing.
  std::vector<std::pair<double, std::size_t>> by_speed;
  for (std::size_t i = 0; i < body_t0.size(); ++i) {
    if (!deep_t0.empty() && (deep_t0[i] != 0 || deep_t1[i] != 0)) continue;
    const double speed = (body_t1[i] - body_t0[i] - mean).norm();
    if (speed > setup.min_substeps * travel) by_speed.emplace_back(-speed, i);
  }
  std::sort(by_speed.begin(), by_speed.end());
  double fastest = 0;
  for (const auto& [negative_speed, i] : by_speed) {
    if (!is_near(body_t0[i], body_t1[i] - mean - body_t0[i], -negative_speed)) continue;
    fastest = -negative_speed;
    break;
  }
  return fastest / travel;
}

}  // namespace

bool slow_down(const ClothModel& model, double h, ClothMotion& m) {
  bool any = false;
  for (std::size_t g = 0; g + 1 < model.first_vertex.size(); ++g) {
    const auto first = at(model.first_vertex[g]), end = at(model.first_vertex[g + 1]);
    const double most = k_most_scatter_of_one * model.typical_edge[g] / h;
    Vec3 mean = Vec3::Zero();
    for (std::size_t i = first; i < end; ++i) mean += m.v[i] / static_cast<double>(end - first);
    for (std::size_t i = first; i < end; ++i) {
      const Vec3 own = m.v[i] - mean;
      const double speed = own.norm();
      if (!(speed > most)) continue;
      m.v[i] = mean + most / speed * own;
      any = true;
    }
  }
  return any;
}

int substep_count(const ClothModel& model, const ClothMotion& motion, double duration, std::span<const Vec3> body_t0,
                  std::span<const Vec3> body_t1, std::span<const char> deep_t0, std::span<const char> deep_t1) {
  const ClothSetup& setup = model.setup;
  const double own = std::max(duration * turning(model.rest_edges, motion) / k_most_turn,
                              duration * scatter(model, motion) / k_most_scatter);
  const double wanted =
      std::ceil(std::max(own, substeps_of_body(model, motion, duration, body_t0, body_t1, deep_t0, deep_t1)));
  return static_cast<int>(std::clamp<double>(wanted, setup.min_substeps, setup.max_substeps));
}

}  // namespace ft::inline solvers

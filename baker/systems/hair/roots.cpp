// Darts that are thrown by area and weight, and refused where one is too near already (Cook 1986, "Stochastic sampling
// in computer graphics"); the distance shrinks until enough have landed. Departs from it: of a limited number of darts,
// so that it ends for every surface.
#include "baker/systems/hair/roots.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "baker/core/check.h"
#include "baker/core/mesh.h"
#include "baker/core/random.h"

namespace ft::inline baker {
namespace {

constexpr int k_darts_each = 8;            ///< darts for every root that is wanted
constexpr double k_first_distance = 0.85;  ///< by the square root of the area that each root has
constexpr double k_shrink = 0.9;
constexpr double k_least_weight = 0.05;  ///< where less is painted, roots keep no more distance than here

using Cell = std::array<std::int64_t, 3>;

class TakenPlaces {
 public:
  explicit TakenPlaces(double cell_size) : size_(cell_size) {}
  bool any_within(const Vec3& place, double distance) const {
    const Cell middle = cell(place);
    for (std::int64_t x = -1; x <= 1; ++x)
      for (std::int64_t y = -1; y <= 1; ++y)
        for (std::int64_t z = -1; z <= 1; ++z) {
          const auto found = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (found == cells_.end()) continue;
          for (const Vec3& p : found->second)
            if ((p - place).squaredNorm() < distance * distance) return true;
        }
    return false;
  }
  void add(const Vec3& place) { cells_[cell(place)].push_back(place); }

 private:
  Cell cell(const Vec3& p) const {
    Cell out;
    for (int k = 0; k < 3; ++k) out[at(k)] = static_cast<std::int64_t>(std::floor(p[k] / size_));
    return out;
  }
  double size_;
  std::map<Cell, std::vector<Vec3>> cells_;
};

double weight_at(const SurfaceRoot& root, std::span<const Triangle> triangles, std::span<const double> weight) {
  double out = 0;
  for (std::size_t k = 0; k < 3; ++k) out += root.weight[k] * weight[at(triangles[at(root.triangle)][k])];
  return out;
}

/// A place of a triangle by its weights: refused by lot where little is painted, at most a few times.
SurfaceRoot dart(const RandomKey& key, std::span<const double> until, std::span<const Vec3> x,
                 std::span<const Triangle> triangles, std::span<const double> weight) {
  const double which = random_uniform(key, 0) * until.back();
  const auto index = std::upper_bound(until.begin(), until.end() - 1, which) - until.begin();
  SurfaceRoot out;
  out.triangle = static_cast<int>(index);
  const Triangle& t = triangles[at(out.triangle)];
  const double most = std::max({weight[at(t[0])], weight[at(t[1])], weight[at(t[2])]});
  for (std::uint64_t draw = 1; draw < 30; draw += 3) {
    const double root = std::sqrt(random_uniform(key, draw)), along = random_uniform(key, draw + 1);
    out.weight = {1 - root, root * (1 - along), root * along};
    if (random_uniform(key, draw + 2) * most <= weight_at(out, triangles, weight)) break;
  }
  for (std::size_t k = 0; k < 3; ++k) out.place += out.weight[k] * x[at(t[k])];
  return out;
}

}  // namespace

std::vector<double> painted_areas(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                                  std::span<const double> weight) {
  std::vector<double> out;
  for (const Triangle& t : triangles)
    out.push_back(triangle_area(positions[at(t[0])], positions[at(t[1])], positions[at(t[2])]) *
                  (weight[at(t[0])] + weight[at(t[1])] + weight[at(t[2])]) / 3);
  return out;
}

std::vector<SurfaceRoot> spread_roots(int count, std::uint64_t seed, std::span<const Vec3> positions,
                                      std::span<const Triangle> triangles, std::span<const double> weight) {
  std::vector<double> until = painted_areas(positions, triangles, weight);
  for (std::size_t i = 1; i < until.size(); ++i) until[i] += until[i - 1];
  CHECK(!until.empty() && until.back() > 0);
  std::vector<SurfaceRoot> darts;
  for (int i = 0; i < k_darts_each * count; ++i)
    darts.push_back(dart({seed, 5, 0, static_cast<std::uint64_t>(i)}, until, positions, triangles, weight));
  std::vector<SurfaceRoot> out;
  std::vector<bool> landed(darts.size(), false);
  double distance = k_first_distance * std::sqrt(until.back() / std::max(1, count));
  TakenPlaces taken(distance / std::sqrt(k_least_weight));
  while (static_cast<int>(out.size()) < count) {
    for (std::size_t i = 0; i < darts.size() && static_cast<int>(out.size()) < count; ++i) {
      if (landed[i]) continue;
      const double w = std::clamp(weight_at(darts[i], triangles, weight), k_least_weight, 1.0);
      if (taken.any_within(darts[i].place, distance / std::sqrt(w))) continue;
      landed[i] = true;
      taken.add(darts[i].place);
      out.push_back(darts[i]);
    }
    distance = distance > 1e-9 ? distance * k_shrink : 0;  // 0: all land
  }
  return out;
}

}  // namespace ft::inline baker

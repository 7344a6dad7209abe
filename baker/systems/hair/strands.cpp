#include "baker/systems/hair/strands.h"

#include <algorithm>
#include <cmath>

#include "baker/core/mesh.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "baker/core/smooth_step.h"
#include "collision/geometry/triangle_tree.h"
#include "io/hair/resample.h"

namespace ft::inline baker {
namespace {

constexpr std::size_t k_neighbours = 8;  ///< of a guide
constexpr double k_apart = 3;         ///< farther than so many times the usual distance of guides is no neighbour [1]
constexpr double k_parted = 0.5;      ///< of the length, by which combed shapes differ on both sides of a parting [1]
constexpr double k_clump_from = 0.7;  ///< of the length, at which clumping is as strong as it gets [1]

class Neighbours {
 public:
  explicit Neighbours(std::span<const HairStrand> guides) : guides_(guides), of_(guides.size()) {
    std::vector<double> nearest(guides.size(), 0.0);
    parallel_for(guides.size(), 16, [&](std::size_t begin, std::size_t end) {
      std::vector<std::pair<double, std::size_t>> all;
      for (std::size_t g = begin; g < end; ++g) {
        all.clear();
        for (std::size_t k = 0; k < guides.size(); ++k)
          if (k != g) all.emplace_back((root(k) - root(g)).squaredNorm(), k);
        const auto kept = std::min(k_neighbours, all.size());
        std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end());
        for (std::size_t k = 0; k < kept; ++k) of_[g].push_back(all[k].second);
        nearest[g] = kept > 0 ? std::sqrt(all[0].first) : 0.0;
      }
    });
    if (guides.empty()) return;
    std::vector<double> sorted = nearest;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
    const double reach = k_apart * sorted[sorted.size() / 2];
    for (std::size_t g = 0; g < guides.size(); ++g)
      std::erase_if(of_[g], [&](std::size_t k) { return (root(k) - root(g)).norm() > reach || parted(g, k); });
  }
  std::span<const std::size_t> of(std::size_t guide) const { return of_[guide]; }
  bool are(std::size_t a, std::size_t b) const { return std::ranges::find(of_[a], b) != of_[a].end(); }
  const Vec3& root(std::size_t guide) const { return guides_[guide].positions[0]; }

 private:
  bool parted(std::size_t a, std::size_t b) const {
    const auto &p = guides_[a].positions, &q = guides_[b].positions;
    double most = 0;
    for (std::size_t i = 0; i < p.size(); ++i) most = std::max(most, ((p[i] - p[0]) - (q[i] - q[0])).norm());
    return most > k_parted * std::max(length_of(p), length_of(q));
  }

  std::span<const HairStrand> guides_;
  std::vector<std::vector<std::size_t>> of_;
};

/// Of a triangle of neighbouring guides, by lot; the largest share first.
BetweenStrand root_of(const StrandsAsked& asked, const Neighbours& neighbours, std::size_t guides, std::size_t number) {
  const auto lot = [&](std::uint64_t draw) { return random_uniform({asked.seed, 7, 0, number}, draw); };
  BetweenStrand out;
  // Every guide has as many.
  const std::size_t first = number % guides;
  const auto around = neighbours.of(first);
  std::array<std::size_t, 3> guide{first, first, first};
  if (!around.empty()) {
    guide[1] =
        around[std::min(around.size() - 1, static_cast<std::size_t>(lot(0) * static_cast<double>(around.size())))];
    // The third is a neighbour of both, on either side of them by lot.
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t k : around) {
      if (k == guide[1] || !neighbours.are(guide[1], k)) continue;
      const double off = (neighbours.root(k) - neighbours.root(guide[1])).norm() * (1 + 0.5 * lot(8 + k % 64));
      if (off < least) least = off, guide[2] = k;
    }
  }
  // In the part of the triangle that is nearest to its first corner; each of its corners is the first for as many
  // strands, so that all of it is filled.
  const double root = std::sqrt(lot(1)), along = lot(2);
  std::array<double, 3> share{1 - root, root * (1 - along), root * along};
  std::ranges::sort(share, std::greater<>());
  for (std::size_t k = 0; k < 3; ++k) {
    const auto known = std::find(out.guides.begin(), out.guides.end(), static_cast<int>(guide[k]));
    const auto slot = known == out.guides.end() ? k : static_cast<std::size_t>(known - out.guides.begin());
    out.guides[slot] = static_cast<int>(guide[k]);
    out.share[slot] += share[k];
  }
  return out;
}

}  // namespace

std::vector<BetweenStrand> strands_between(const StrandsAsked& asked, std::span<const HairStrand> guides,
                                           const Trajectory& scalp) {
  std::vector<BetweenStrand> out(guides.empty() ? 0 : at(asked.count));
  const Neighbours neighbours(guides);
  const std::vector<Vec3> bind = bind_pose_of(scalp);
  const TriangleTree tree(bind, scalp.surface().triangles);
  parallel_for(out.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      BetweenStrand& strand = out[s] = root_of(asked, neighbours, guides.size(), s);
      Vec3 root = Vec3::Zero();
      double off = 0;
      const auto to_skin = [&](const Vec3& p) {
        TriangleTree::Hit hit;
        tree.closest(p, bind, scalp.surface().triangles, hit);
        return Vec3(hit.closest.point - p);
      };
      for (std::size_t k = 0; k < 3; ++k) {
        if (strand.guides[k] < 0) continue;
        const Vec3& own = neighbours.root(at(strand.guides[k]));
        root += strand.share[k] * own;
        off += strand.share[k] * to_skin(own).norm();
      }
      // As far from the skin as the guides' roots are.
      const Vec3 onto = to_skin(root);
      if (onto.norm() > off) root += (1 - off / onto.norm()) * onto;
      const std::vector<Vec3>& nearest = guides[at(strand.guides[0])].positions;
      std::vector<Vec3> line(nearest.size(), root);
      for (std::size_t i = 1; i < line.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k)
          if (strand.guides[k] >= 0) {
            const std::vector<Vec3>& own = guides[at(strand.guides[k])].positions;
            line[i] += strand.share[k] * (own[i] - own[0]);
          }
        const double along = static_cast<double>(i) / static_cast<double>(line.size() - 1);
        line[i] += asked.clumping * smooth_step(along / k_clump_from) * (nearest[i] - line[i]);
      }
      const double shorter = asked.length_variation * random_uniform({asked.seed, 7, 0, s}, 3);
      strand.positions = resampled(cut_to(line, (1 - shorter) * length_of(line)), static_cast<int>(line.size()));
      strand.width = asked.width;
    }
  });
  return out;
}

}  // namespace ft::inline baker

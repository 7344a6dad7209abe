// A strand is walked in small steps: its direction turns to the comb over the bending length, and where it comes nearer
// to the body than its layer it is pushed out and goes along the surface. Then strands of a lock draw together towards
// the tip, curls wind about them, and what that has put into the body is pushed out again. Careful: the layers, each
// strand's own height above the body, are what gives hair volume; without them all would lie in one skin.
#include "baker/systems/hair/growth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/mesh.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "baker/core/smooth_step.h"
#include "baker/systems/hair/outside.h"
#include "baker/systems/hair/roots.h"
#include "io/hair/resample.h"

namespace ft::inline baker {
namespace {

using std::numbers::pi;

constexpr double k_step = 0.003;       ///< of the walk [m]
constexpr double k_spare = 1.3;        ///< walked length by wanted length: pushing and clumping eat some
constexpr double k_layer_rise = 0.06;  ///< after which length a strand is in its layer [m]
constexpr double k_part_reach = 0.05;  ///< how far from a parting it is felt [m]
constexpr double k_part_pull = 2.5;    ///< of a parting at its line, beside the comb [1]
constexpr double k_jitter = 0.12;      ///< by which directions at the root differ [1]
constexpr double k_chord_gap = 3e-4;   ///< of middles of segments to the body [m]
constexpr int k_rounds = 6;            ///< of pushing them out
constexpr double k_clump_pull = 0.8;   ///< of the way to its lock's middle, at the tip [1]

/// Numbers of a strand: its own, whatever others do.
double lot(const Growth& g, std::size_t strand, std::uint64_t draw) {
  return random_uniform({g.seed, 6, 0, strand}, draw);
}

/// Of a vector the part along a surface.
Vec3 along_surface(const Vec3& v, const Vec3& normal) {
  return v - v.dot(normal) * normal;
}

/// To which side of a parting a place is, and how much it feels of it: 0 far away, up to 1 or -1 at the line.
struct Side {
  Vec3 across = Vec3::Zero();  ///< unit, of the parting
  double sign = 1, felt = 0;
};
Side side_of(const Growth& g, const Vec3& place, const Vec3& normal) {
  if (!g.part) return {};
  Side out;
  const Vec3 along = g.part->direction.normalized();
  out.across = along.cross(normal);
  if (out.across.norm() < 1e-6) return {};
  out.across.normalize();
  const double distance = (place - g.part->point).dot(out.across);
  out.sign = distance < 0 ? -1 : 1;
  out.felt = std::exp(-distance * distance / (k_part_reach * k_part_reach));
  return out;
}

class Grower {
 public:
  Grower(const Growth& g, std::span<const Vec3> x, std::span<const Triangle> triangles, const PaintedRegion& region,
         std::vector<SurfaceRoot> roots)
      : g_(g),
        triangles_(region.triangles),
        normals_(vertex_normals(region.positions, region.triangles)),
        outside_(x, triangles),
        roots_(std::move(roots)),
        comb_(g.comb.normalized()) {
    std::erase_if(roots_, [&](const SurfaceRoot& root) {
      return outside_.is_inside(root.place + k_strand_gap / 4 * normal_of(root));
    });
  }

  std::vector<GrownStrand> run() {
    std::vector<std::vector<Vec3>> lines(roots_.size());
    parallel_for(lines.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) lines[i] = walk(i);
    });
    const std::vector<std::size_t> locks = locks_of();
    std::vector<GrownStrand> out(roots_.size());
    parallel_for(lines.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        out[i] = {finished(i, locks[i], lines), roots_[i].triangle, roots_[i].weight};
    });
    return out;
  }

 private:
  Vec3 normal_of(const SurfaceRoot& root) const {
    Vec3 out = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) out += root.weight[k] * normals_[at(triangles_[at(root.triangle)][k])];
    return out.normalized();
  }

  double length_of_strand(std::size_t i) const {
    return g_.length * (1 + g_.length_variation * (2 * lot(g_, i, 0) - 1));
  }

  /// Above the body, after a length of strand [m]; never more than the strand may have risen.
  double gap_at(std::size_t i, double length) const {
    const double layer = k_strand_gap + g_.volume * lot(g_, i, 1) * smooth_step(length / k_layer_rise);
    return std::min(layer, 0.7 * length);
  }

  Vec3 first_direction(std::size_t i, const Vec3& normal) const {
    const SurfaceRoot& root = roots_[i];
    const Side side = side_of(g_, root.place, normal);
    Vec3 flat = along_surface(comb_ + k_part_pull * side.felt * side.sign * side.across, normal);
    for (int k = 0; k < 3; ++k) flat[k] += k_jitter * (2 * lot(g_, i, 2 + static_cast<std::uint64_t>(k)) - 1);
    flat = along_surface(flat, normal).normalized();
    return (g_.lift * normal + (1 - g_.lift) * flat).normalized();
  }

  /// From the root on, longer than the strand will be, without locks and curls.
  std::vector<Vec3> walk(std::size_t i) const {
    const Vec3 normal = normal_of(roots_[i]);
    std::vector<Vec3> out{roots_[i].place};
    Vec3 direction = first_direction(i, normal);
    const int steps = static_cast<int>(std::ceil(k_spare * length_of_strand(i) / k_step));
    for (int s = 1; s <= steps; ++s) {
      const auto pushed = outside_.out(out.back() + k_step * direction, gap_at(i, s * k_step));
      out.push_back(pushed.place);
      if (const double into = direction.dot(pushed.normal); into < 0) {
        const Vec3 slid = along_surface(direction, pushed.normal);
        direction = slid.norm() > 0.05 ? slid.normalized() : direction;
      }
      const Vec3 turned = direction + std::min(1.0, k_step / g_.bend) * (comb_ - direction);
      if (turned.norm() > 1e-6) direction = turned.normalized();
    }
    return out;
  }

  /// For each strand the one in the middle of its lock; itself where there are no locks.
  std::vector<std::size_t> locks_of() const {
    std::vector<std::size_t> out(roots_.size()), middles;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      out[i] = i;
      if (!(g_.clump_size > 0)) continue;
      const bool is_middle = std::ranges::none_of(
          middles, [&](std::size_t m) { return (roots_[m].place - roots_[i].place).norm() < g_.clump_size; });
      if (is_middle) middles.push_back(i);
    }
    if (!(g_.clump_size > 0)) return out;
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      double least = std::numeric_limits<double>::infinity();
      for (const std::size_t m : middles) {
        const double d = (roots_[m].place - roots_[i].place).squaredNorm();
        if (d < least && same_side(i, m)) least = d, out[i] = m;
      }
    }
    return out;
  }
  bool same_side(std::size_t a, std::size_t b) const {
    if (!g_.part) return true;
    return side_of(g_, roots_[a].place, normal_of(roots_[a])).sign ==
           side_of(g_, roots_[b].place, normal_of(roots_[b])).sign;
  }

  std::vector<Vec3> finished(std::size_t i, std::size_t lock, const std::vector<std::vector<Vec3>>& lines) const {
    std::vector<Vec3> line = lines[i];
    const double length = length_of_strand(i);
    const auto count = static_cast<double>(line.size() - 1);
    for (std::size_t s = 1; s < line.size() && lock != i; ++s) {
      const double along = static_cast<double>(s) / count;
      const Vec3& middle = lines[lock][std::min(s, lines[lock].size() - 1)];
      line[s] += k_clump_pull * smooth_step(along / 0.7) * (middle - line[s]);
    }
    if (g_.curl_radius > 0) curl(line, lock);
    double walked = 0;
    for (std::size_t s = 1; s < line.size(); ++s) {
      walked += k_step;
      line[s] = outside_.out(line[s], gap_at(i, walked)).place;
    }
    line = resampled(cut_to(line, length), g_.vertices);
    // Chords of coarse strands cut through what the fine ones go round.
    push_out(line);
    for (int round = 0; round < k_rounds && push_chords_out(line); ++round) push_out(line);
    return line;
  }

  void push_out(std::vector<Vec3>& line) const {
    for (std::size_t s = 1; s < line.size(); ++s) line[s] = outside_.out(line[s], k_strand_gap).place;
  }
  /// Whether any had to be.
  bool push_chords_out(std::vector<Vec3>& line) const {
    bool cuts = false;
    for (std::size_t s = 1; s < line.size(); ++s) {
      const Vec3 middle = 0.5 * (line[s - 1] + line[s]), off = outside_.out(middle, k_chord_gap).place - middle;
      if (off.isZero(0)) continue;
      cuts = true;
      line[s] += off;
      if (s > 1) line[s - 1] += off;
    }
    return cuts;
  }

  /// A helix about the line. The strands of a lock wind together.
  void curl(std::vector<Vec3>& line, std::size_t lock) const {
    const double phase = 2 * pi * lot(g_, lock, 8), pitch = g_.curl_pitch * (0.85 + 0.3 * lot(g_, lock, 9));
    const std::vector<Vec3> middle = line;
    Vec3 across = (middle[1] - middle[0]).unitOrthogonal();
    for (std::size_t s = 1; s < line.size(); ++s) {
      const Vec3 tangent = (middle[s] - middle[s - 1]).normalized();
      const Vec3 carried = along_surface(across, tangent);  // without twist
      across = carried.norm() > 1e-6 ? carried.normalized() : tangent.unitOrthogonal();
      const double place = static_cast<double>(s) * k_step, angle = phase + 2 * pi * place / pitch;
      const double radius = g_.curl_radius * smooth_step(place / (2 * pitch));
      line[s] += radius * (std::cos(angle) * across + std::sin(angle) * tangent.cross(across));
    }
  }

  const Growth& g_;
  std::span<const Triangle> triangles_;  ///< of the region
  std::vector<Vec3> normals_;            ///< of its vertices
  Outside outside_;
  std::vector<SurfaceRoot> roots_;
  Vec3 comb_;
};

/// What of it makes no sense; empty: all does.
std::string fault_of(const Growth& g, const PaintedRegion& region) {
  const auto within = [](double v, double lo, double hi) { return v >= lo && v <= hi; };
  if (!(g.density > 0) || !std::isfinite(g.density)) return "density has to be above 0";
  if (!within(g.length, 1e-3, 10)) return "length has to be from 1 mm to 10 m";
  if (!within(g.length_variation, 0, 0.95)) return "length_variation has to be from 0 to 0.95";
  if (!within(g.curl_radius, 0, 1)) return "curl_radius has to be from 0 to 1 m";
  if (g.curl_radius > 0 && !within(g.curl_pitch, 1e-3, 10)) return "curl_pitch has to be from 1 mm to 10 m";
  if (!within(g.clump_size, 0, 10)) return "clump_size has to be from 0 to 10 m";
  if (!within(g.lift, 0, 1)) return "lift has to be from 0 to 1";
  if (!within(g.bend, 1e-3, 100)) return "bend has to be from 1 mm to 100 m";
  if (!within(g.volume, 0, 1)) return "volume has to be from 0 to 1 m";
  if (!(g.comb.norm() > 0) || !g.comb.allFinite()) return "comb has to be a direction";
  if (g.part && (!(g.part->direction.norm() > 0) || !g.part->direction.allFinite() || !g.part->point.allFinite()))
    return "part has to be a point and a direction";
  if (!within(g.vertices, 2, 10000)) return "vertices have to be from 2 to 10000";
  if (region.weight.size() != region.positions.size()) return "the region is painted on another mesh";
  for (const double w : region.weight)
    if (!within(w, 0, 1)) return "the region's weights have to be from 0 to 1";
  return {};
}

}  // namespace

double painted_area(const PaintedRegion& region) {
  double out = 0;
  for (const double a : painted_areas(region.positions, region.triangles, region.weight)) out += a;
  return out;
}

Result<std::vector<GrownStrand>> grown(const Growth& growth, std::span<const Vec3> body,
                                       std::span<const Triangle> body_triangles, const PaintedRegion& region) {
  if (const std::string fault = fault_of(growth, region); !fault.empty()) return usage_error(fault);
  const double area = painted_area(region);
  if (!(area > 0)) return usage_error("hair grows nowhere: no area of the region is painted");
  const double count = std::round(area * growth.density);
  if (count < 1)
    return usage_error(fmt::format("hair has no strand: the painted area is {:.3g} m2, at {:.3g} strands per m2", area,
                                   growth.density));
  if (count > k_most_strands)
    return usage_error(fmt::format("hair would have {:.0f} strands; {:.0f} are the most", count, k_most_strands), {},
                       "lower the density");
  return Grower(growth, body, body_triangles, region,
                spread_roots(static_cast<int>(count), growth.seed, region.positions, region.triangles, region.weight))
      .run();
}

}  // namespace ft::inline baker

#include "solvers/cloth/model/sewing.h"

#include <algorithm>
#include <cmath>

#include "solvers/energies/seams.h"

namespace ft::inline solvers {
namespace {

/// Slows cloth down while it is sewn [1/s]: ten times the speed of seams that shrink in half a second.
constexpr double k_drag = 10;
/// Cloth keeps this share of its weight, at which it sinks by 5 cm/s: a sleeve that was laid out beside the top of an
/// arm closes around it then, and not above it.
constexpr double k_weight_kept = 0.05;
/// The rest comes back over this share of the time that the seams took, friction after it over the next.
constexpr double k_weight_back = 0.5, k_friction_back = 0.25;

/// Seams that do not say how long they take are closed after this share of the pre-roll.
constexpr double k_share_of_preroll = 0.5;
/// A seam that holds degenerate triangles only is taken to be so long [m].
constexpr double k_shortest = 1e-5;

}  // namespace

std::vector<double> seam_lengths(const ClothTopology& topology) {
  struct Side {
    Edge edge;
    double length;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    if (topology.rest_area[t] == 0) continue;
    const Triangle& v = topology.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = v[(k + 1) % 3], b = v[(k + 2) % 3];
      sides.push_back({{std::min(a, b), std::max(a, b)}, rest_length(topology, t, k)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
  std::vector<double> out(at(topology.vertex_count), 0.0), any(out);
  for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
    for (const int v : sides[i].edge) {
      any[at(v)] = std::max(any[at(v)], sides[i].length);
      if (end - i == 1) out[at(v)] += 0.5 * sides[i].length;
    }
  }
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::max(out[i] == 0 ? any[i] : out[i], k_shortest);  // 0: inside a panel, a dart or a pocket
  return out;
}

void sew(ClothModel& model) {
  const ClothSetup& setup = model.setup;
  std::vector<Stitch> stitches;
  for (std::size_t g = 0; g < setup.garments.size(); ++g)
    for (Stitch s : setup.garments[g].mesh.stitches) {
      s.vertex += model.first_vertex[g];
      for (int& v : s.edge) v += model.first_vertex[g];
      s.seam = 0;
      stitches.push_back(s);
    }
  if (stitches.empty()) return;
  std::sort(stitches.begin(), stitches.end());
  stitches.erase(std::unique(stitches.begin(), stitches.end()), stitches.end());
  model.sewn = SewnPairs(model.vertex_count(), stitches, model.triangles);
  const std::vector<double> length = seam_lengths(*model.topology);
  const double begin = -setup.preroll_frames / setup.fps;
  const auto closed_at = [&](const ClothGarment& garment) {
    return begin + (garment.sewing_time > 0 ? garment.sewing_time : -k_share_of_preroll * begin);
  };
  model.sewn_until.assign(at(model.vertex_count()), begin);
  std::vector<int> count(at(model.vertex_count()), 0);
  for (const Stitch& s : stitches) ++count[at(s.vertex)];
  const SeamSettings settings;
  for (const Stitch& s : stitches) {
    const ClothGarment& garment = setup.garments[at(model.garment_of(s.vertex))];
    SeamPoint point;
    point.vertex = s.vertex;
    point.edge = s.edge;
    point.place = s.place;
    const auto& x = model.start;
    point.start_gap = (x[at(s.vertex)] - (1 - s.place) * x[at(s.edge[0])] - s.place * x[at(s.edge[1])]).norm();
    point.opens_at = begin;
    point.closed_at = closed_at(garment);
    const double held = length[at(s.vertex)] / count[at(s.vertex)];
    point.stiffness = settings.stiffness * held;
    point.pull = settings.pull * held;
    point.hold = settings.hold * held;
    model.topology->seams.push_back(point);
  }
  for (std::size_t g = 0; g < setup.garments.size(); ++g) {
    if (setup.garments[g].mesh.stitches.empty()) continue;
    std::fill(model.sewn_until.begin() + model.first_vertex[g], model.sewn_until.begin() + model.first_vertex[g + 1],
              closed_at(setup.garments[g]));
  }
}

void lengths_from_pattern(const ClothTopology& topology, RestEdges& edges) {
  const auto index_of = [&](int a, int b) {
    const Edge edge{std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(edges.edges.begin(), edges.edges.end(), edge);
    return found != edges.edges.end() && *found == edge ? static_cast<std::size_t>(found - edges.edges.begin())
                                                        : edges.edges.size();
  };
  std::vector<double> sum(edges.edges.size(), 0.0);
  std::vector<int> count(edges.edges.size(), 0);
  for (std::size_t t = 0; t < topology.triangles.size(); ++t) {
    if (!(topology.pieces[at(topology.triangle_piece[t])].pattern_scale > 0) || topology.rest_area[t] == 0) continue;
    const Triangle& v = topology.triangles[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = index_of(v[(k + 1) % 3], v[(k + 2) % 3]);
      if (i == edges.edges.size()) continue;
      sum[i] += rest_length(topology, t, k);
      ++count[i];
    }
  }
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i] > 0) edges.lengths[i] = sum[i] / count[i];
  for (const FlippedCap& cap : topology.flipped_caps)
    if (const std::size_t i = index_of(cap.base[0], cap.base[1]); i < edges.edges.size())
      edges.lengths[i] = cap.base_length;
}

bool ease_sewing(const ClothModel& model, double time, std::span<const Vec3> v, std::span<Vec3> acceleration) {
  const double begin = -model.setup.preroll_frames / model.setup.fps;
  bool any = false;
  for (std::size_t i = 0; i < model.sewn_until.size(); ++i) {
    const double lasts = model.sewn_until[i] - begin;
    if (!(lasts > 0) || model.unused[i]) continue;
    const double ease = std::clamp(1 - (time - model.sewn_until[i]) / (k_weight_back * lasts), 0.0, 1.0);
    if (ease == 0) continue;
    acceleration[i] -= ease * ((1 - k_weight_kept) * model.setup.gravity + k_drag * v[i]);
    any = true;
  }
  return any;
}

double sewing_friction(const ClothModel& model, double time) {
  const double begin = -model.setup.preroll_frames / model.setup.fps;
  double share = 1;
  for (std::size_t g = 0; g < model.setup.garments.size() && !model.sewn_until.empty(); ++g) {
    const double until = model.sewn_until[at(model.first_vertex[g])], lasts = until - begin;
    if (lasts > 0) share = std::min(share, (time - until - k_weight_back * lasts) / (k_friction_back * lasts));
  }
  return std::max(share, 0.0);
}

}  // namespace ft::inline solvers

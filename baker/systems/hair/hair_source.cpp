#include "baker/systems/hair/hair_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "baker/core/mesh.h"
#include "collision/check/crossings.h"
#include "io/hair/guides.h"
#include "io/hair/resample.h"
#include "io/shot/mesh_file.h"
#include "io/shot/ranges.h"

namespace ft::inline baker {
namespace {

constexpr double k_rim = 0.2;  ///< of a region's radius, within which its hair becomes thin

constexpr double k_sharp = 1;  ///< turn at a vertex beyond which a curve is no curve any more [rad]

/// Largest turn from a segment to the next [rad].
double sharpest(std::span<const Vec3> line) {
  double out = 0;
  for (std::size_t i = 2; i < line.size(); ++i) {
    const Vec3 a = line[i - 1] - line[i - 2], b = line[i] - line[i - 1];
    out = std::max(out, std::atan2(a.cross(b).norm(), a.dot(b)));
  }
  return out;
}

/// `count` of so many, evenly.
std::vector<std::size_t> evenly(std::span<const std::size_t> all, int count) {
  const std::size_t wanted = count > 0 ? std::min(all.size(), at(count)) : all.size();
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < wanted; ++k) out.push_back(all[k * all.size() / wanted]);
  return out;
}

/// Of so many strands those that are not left out; a usage error names what is not there, and where nothing is left.
Result<std::vector<std::size_t>> chosen(std::size_t count, const std::string& leave_out) {
  std::vector<int> ids;
  std::string fault;
  if (!leave_out.empty() && !parse_vertices(leave_out, ids, fault)) return usage_error("leave_out: " + fault);
  if (!ids.empty() && at(ids.back()) >= count)
    return usage_error(fmt::format("leave_out names strand {}, and the file has {}, from 0", ids.back(), count));
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < count; ++k)
    if (!std::binary_search(ids.begin(), ids.end(), static_cast<int>(k))) out.push_back(k);
  if (out.empty()) return usage_error(fmt::format("leave_out names all of its {} strands", count));
  return out;
}

/// The solved one among guides that is most like a guide.
int nearest_solved(const GuideSet& guides, std::span<const int> solved, std::size_t guide) {
  if (solved[guide] >= 0) return solved[guide];
  const auto off = [&](std::size_t k) {
    return (guides.strands[k].front() - guides.strands[guide].front()).norm() +
           (guides.strands[k].back() - guides.strands[guide].back()).norm();
  };
  std::size_t best = solved.size();
  for (std::size_t k = 0; k < solved.size(); ++k)
    if (solved[k] >= 0 && (best == solved.size() || off(k) < off(best))) best = k;
  return solved[best];
}

Result<HairSource> from_file(const HairSpec& spec, std::span<const Vec3> bind) {
  HairSource out;
  std::vector<Vec3> there(bind.begin(), bind.end());  // as the file has it
  for (Vec3& p : there) p -= spec.position;
  auto guides = read_guides(spec.guides, spec.scale, there);
  if (!guides) return guides.error();
  out.notes = std::move(guides->notes);
  auto wanted = chosen(guides->strands.size(), spec.leave_out);
  if (!wanted) return wanted.error();
  std::vector<int> solved(guides->strands.size(), -1);
  for (const std::size_t k : evenly(*wanted, spec.count)) {
    solved[k] = static_cast<int>(out.strands.size());
    HairStrand& strand = out.strands.emplace_back();
    strand.id = k;
    strand.positions = resampled(guides->strands[k], spec.vertices);
    for (Vec3& p : strand.positions) p += spec.position;
    strand.width = guides->widths.empty() ? spec.width : guides->widths[k];
  }
  if (guides->ridden.positions.empty()) return out;
  out.ridden = std::move(guides->ridden);
  for (Vec3& p : out.ridden.positions) p += spec.position;
  // Caps and the like lie on the head.
  for (const Rider& rider : guides->riders)
    out.riders.push_back(
        {rider.strand < 0 || !rider.of_strand ? -1 : nearest_solved(*guides, solved, at(rider.strand)), rider.along});
  return out;
}

/// Of each vertex, how much hair it has.
std::vector<double> weights_in_ball(const HairSpec& spec, std::span<const Vec3> body) {
  std::vector<double> out;
  for (const Vec3& p : body) {
    const double outwards = (p - spec.region).norm() / spec.region_radius;
    out.push_back(std::clamp((1 - outwards) / k_rim, 0.0, 1.0));
  }
  return out;
}

/// By the red of its colours, where it has any.
std::vector<double> painted_red(const Mesh& mesh) {
  if (mesh.groups.empty()) return std::vector<double>(mesh.positions.size(), 1.0);
  std::vector<double> out(mesh.positions.size(), 0.0);
  for (const VertexGroup& group : mesh.groups)
    if (group.name == "red")
      for (std::size_t k = 0; k < group.vertices.size(); ++k) out[at(group.vertices[k])] = group.weights[k];
  return out;
}

void add_surface(std::span<const Vec3> x, std::span<const Triangle> triangles, std::vector<Vec3>& all,
                 std::vector<Triangle>& all_triangles) {
  const int first = static_cast<int>(all.size());
  all.insert(all.end(), x.begin(), x.end());
  for (const Triangle& t : triangles) all_triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

/// How many went through.
std::size_t leave_out_through(std::span<const Vec3> x, std::span<const Triangle> triangles,
                              std::vector<GrownStrand>& strands) {
  if (triangles.empty()) return 0;
  const TriangleTree tree(x, triangles);
  return std::erase_if(strands, [&](const GrownStrand& strand) {
    bool through = false;
    for (std::size_t i = 1; i < strand.line.size() && !through; ++i)
      through = edge_crosses_any(strand.line[i - 1], strand.line[i], tree, x, triangles);
    return through;
  });
}

Result<HairSource> from_region(const HairSpec& spec, std::span<const Vec3> body, std::span<const Triangle> triangles,
                               std::span<const HairBody> bodies) {
  HairSource out;
  Mesh own;
  std::vector<Triangle> own_triangles;
  std::vector<double> weight;
  PaintedRegion region{body, triangles, {}};
  if (spec.region_mesh.empty()) {
    weight = weights_in_ball(spec, body);
  } else {
    auto mesh = read_obj(spec.region_mesh);
    if (!mesh) return mesh.error();
    own = std::move(*mesh);
    for (Vec3& p : own.positions) p = spec.scale * p + spec.position;
    own_triangles = triangulate(own);
    if (own_triangles.empty())
      return input_error("it has no faces to grow hair on", spec.region_mesh.filename().string());
    weight = painted_red(own);
    region = {own.positions, own_triangles, {}};
  }
  region.weight = weight;
  Growth growth = spec;
  growth.seed = static_cast<std::uint64_t>(spec.seed_number);
  if (spec.parting_along != Vec3::Zero()) growth.part = Parting{spec.parting_at, spec.parting_along};
  const double area = painted_area(region);
  if (spec.count > 0 && area > 0) growth.density = spec.count / area;
  if (!(area > 0) && !spec.region_mesh.empty())
    return usage_error("hair grows nowhere: no vertex has any red", spec.region_mesh.filename().string(),
                       "hair is as dense as the red of its vertices' colours; without colours it is everywhere");
  if (!(area > 0) && spec.region_mesh.empty()) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : body) least = std::min(least, (p - spec.region).norm());
    return usage_error(
        fmt::format("hair grows nowhere: the nearest vertex of the body is {:.3g} m from the middle of the region, "
                    "whose radius is {:.3g} m",
                    least, spec.region_radius),
        {}, "region is a place on the body as garments lie on it, in its bind pose");
  }
  // A garment is so nearly closed around what it covers that winding numbers tell its inside; but not beside its rims.
  std::vector<Vec3> covered(body.begin(), body.end()), sheets;
  std::vector<Triangle> cover(triangles.begin(), triangles.end()), sheet_triangles;
  for (const HairBody& met : bodies) {
    if (!met.sheet) continue;
    const std::vector<Vec3> bind = bind_pose_of(*met.trajectory);
    add_surface(bind, met.trajectory->surface().triangles, covered, cover);
    add_surface(bind, met.trajectory->surface().triangles, sheets, sheet_triangles);
  }
  auto strands = grown(growth, covered, cover, region);
  if (!strands) return strands.error();
  const auto wanted = static_cast<std::size_t>(std::llround(area * growth.density));
  if (strands->size() < wanted)
    out.notes.push_back(
        fmt::format("{} of {} guides would begin inside of the body, under another layer of it: left out",
                    wanted - strands->size(), wanted));
  if (const std::size_t through = leave_out_through(sheets, sheet_triangles, *strands); through > 0)
    out.notes.push_back(fmt::format("{} guides would grow through a garment: left out", through));
  for (GrownStrand& grown_strand : *strands) {
    HairStrand& strand = out.strands.emplace_back();
    strand.id = out.strands.size() - 1;
    strand.positions = std::move(grown_strand.line);
    strand.width = spec.width;
  }
  return out;
}

}  // namespace

Result<HairSource> hair_source(const HairSpec& spec, const Trajectory& scalp, std::span<const HairBody> bodies) {
  const std::vector<Vec3> bind = bind_pose_of(scalp);
  auto out = spec.grows() ? from_region(spec, bind, scalp.surface().triangles, bodies) : from_file(spec, bind);
  if (!out) return out;
  const auto bent =
      std::ranges::count_if(out->strands, [](const HairStrand& s) { return sharpest(s.positions) > k_sharp; });
  if (bent > 0)
    out->notes.push_back(
        fmt::format("{} of {} strands turn by more than {:.0f} degrees at a vertex, in tight curls or at "
                    "corners: {} vertices round them off; more vertices keep them",
                    bent, out->strands.size(), k_sharp * 180 / std::numbers::pi, spec.vertices));
  // Held to where it leaves the band; what ends in it, whole.
  for (HairStrand& strand : out->strands)
    for (std::size_t i = 0; i < strand.positions.size(); ++i)
      if ((strand.positions[i] - spec.tie).norm() < spec.tie_radius) strand.held = static_cast<int>(i) + 1;
  return out;
}

}  // namespace ft::inline baker

// How garments lie where a bake starts.
#include <algorithm>
#include <map>

#include "baker/plan/start_report.h"
#include "baker/systems/cloth/cloth_group.h"
#include "collision/check/crossings.h"
#include "collision/check/penetration.h"
#include "collision/check/sewn_pairs.h"

namespace ft::inline baker {
namespace {

/// All garments of a group where the bake puts them first, in one numbering.
struct Start {
  std::vector<Vec3> x;
  std::vector<Triangle> triangles;
  std::vector<int> first_vertex;  ///< of each garment; one more at the end
  SewnPairs sewn;

  std::size_t garment_of(int vertex) const {
    return static_cast<std::size_t>(std::upper_bound(first_vertex.begin(), first_vertex.end(), vertex) -
                                    first_vertex.begin()) -
           1;
  }
};

Start place(const ClothSetup& setup) {
  Start out;
  std::vector<Stitch> stitches;
  for (const ClothGarment& garment : setup.garments) {
    const int first = static_cast<int>(out.x.size());
    out.first_vertex.push_back(first);
    const bool in_the_world =
        std::any_of(garment.pins.begin(), garment.pins.end(), [](const ClothPin& pin) { return pin.to_world; });
    const Eigen::Isometry3d move = in_the_world     ? Eigen::Isometry3d::Identity()
                                   : garment.wearer ? garment.wearer->to_start
                                                    : setup.primary->bind_to_start();
    for (const Vec3& p : garment.mesh.positions) out.x.push_back(move * p);
    for (const Triangle& t : triangulate(garment.mesh))
      out.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    for (Stitch s : garment.mesh.stitches) {
      s.vertex += first, s.edge[0] += first, s.edge[1] += first;
      stitches.push_back(s);
    }
  }
  out.first_vertex.push_back(static_cast<int>(out.x.size()));
  out.sewn = SewnPairs(static_cast<int>(out.x.size()), stitches, out.triangles);
  return out;
}

/// primary: what the body is called.
void add_body(const ClothSetup& setup, const std::string& primary, const Start& start, std::vector<BadStart>& bad) {
  const double time = -setup.preroll_frames / setup.fps;
  std::vector<Vec3> drawn(at(setup.primary->surface().vertex_count())),
      body(at(setup.poses->collider().vertex_count()));
  setup.primary->sample(time, drawn);
  std::vector<char> deep(body.size());
  setup.poses->evaluate(time, drawn, body, deep);
  std::vector<std::vector<char>> absent;  // of each garment
  const auto part_of = setup.poses->collider().part_of_vertex();
  for (const ClothGarment& garment : setup.garments) {
    std::vector<char>& own = absent.emplace_back(deep);
    for (std::size_t v = 0; v < own.size(); ++v)
      if (std::find(garment.ignores.begin(), garment.ignores.end(), part_of[v]) != garment.ignores.end()) own[v] = 1;
  }
  const auto triangles = setup.poses->collider().triangles();
  const auto touch = [&](int vertex) -> BadStart& {
    BadStart& entry = bad[start.garment_of(vertex)];
    if (entry.vertex < 0) entry.vertex = vertex;
    return entry;
  };
  for (const ClothGarment& garment : setup.garments) bad.push_back({garment.name, primary, true});
  for (const Crossing& c : crossings_between(start.x, start.triangles, body, triangles)) {
    const int vertex = c.edge_of_first ? c.edge[0] : c.triangle[0];
    if (!second_is_marked(c, absent[start.garment_of(vertex)])) ++touch(vertex).crossings;
  }
  const std::vector<Triangle> solid = solid_triangles(triangles, part_of, setup.primary->surface().parts);
  for (const Penetration& p : penetrations(start.x, body, solid)) {
    BadStart& entry = touch(p.vertex);
    ++entry.inside;
    if (p.depth > entry.depth) entry.depth = p.depth, entry.vertex = p.vertex;
  }
}

void add_cloths(const ClothSetup& setup, const Start& start, std::vector<BadStart>& bad) {
  std::map<std::pair<std::size_t, std::size_t>, BadStart> pairs;
  for (const Crossing& c : crossings_within(start.x, start.triangles)) {
    const auto [a, b] = std::minmax({start.garment_of(c.edge[0]), start.garment_of(c.triangle[0])});
    if (start.sewn.together(c) || (a == b && !setup.garments[a].self_collision)) continue;
    BadStart& entry = pairs[{a, b}];
    entry.cloth = setup.garments[a].name, entry.other = setup.garments[b].name;
    if (entry.vertex < 0) entry.vertex = start.garment_of(c.edge[0]) == a ? c.edge[0] : c.triangle[0];
    ++entry.crossings;
  }
  for (auto& [pair, entry] : pairs) bad.push_back(std::move(entry));
}

}  // namespace

void ClothGroup::add_start(const BakePlan& plan, StartReport& report) const {
  if (setup.garments.empty()) return;
  report.garment_count += static_cast<int>(setup.garments.size());
  const Start start = place(setup);
  std::vector<BadStart> bad;
  add_body(setup, joint ? joint->text() : plan.primaries[primary].name, start, bad);
  add_cloths(setup, start, bad);
  for (BadStart& b : bad) {
    if (b.vertex < 0) continue;
    b.place = start.x[at(b.vertex)];
    const std::size_t garment = start.garment_of(b.vertex);
    b.vertex = outputs[garment].in_file.vertex(b.vertex - start.first_vertex[garment]);
    report.bad.push_back(std::move(b));
  }
}

}  // namespace ft::inline baker

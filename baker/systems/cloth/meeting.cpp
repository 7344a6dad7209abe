#include "baker/systems/cloth/meeting.h"

#include <algorithm>
#include <limits>

#include "baker/core/disjoint_sets.h"

namespace ft::inline baker {
namespace {

/// Cloth that nothing holds may slide and swing so much farther than its own size [m].
constexpr double k_margin = 0.25;

/// Where a body is in each interval between two frames, the first one before the shot.
std::vector<Box> boxes_of(const Shot& shot, const Trajectory& body) {
  std::vector<Box> ends;
  std::vector<Vec3> x(at(body.surface().vertex_count()));
  for (int frame = shot.first_frame - shot.preroll; frame <= shot.last_frame; ++frame) {
    body.sample((frame - shot.first_frame) / shot.fps, x);
    ends.push_back(bounds(x));
  }
  std::vector<Box> out;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    out.push_back(ends[k]);
    out.back().include(ends[k + 1]);
  }
  if (out.empty()) out = ends;
  return out;
}

/// Where the cloth may be, in each of the same intervals.
std::vector<Box> boxes_of(const ClothReach& cloth, const std::vector<Box>& wearer, const Shot& shot,
                          double fastest_wind) {
  std::vector<Box> out = wearer;
  const double reach = cloth.start.size().norm() + k_margin;
  for (Box& box : out) box.inflate(reach);
  if (!cloth.may_leave) return out;
  // Once it has left, it is anywhere below or as far as the wind may have blown it.
  const double seconds = (shot.last_frame - shot.first_frame + shot.preroll) / shot.fps;
  const double blown = seconds * fastest_wind;
  Box all = cloth.start;
  all.inflate(reach);
  for (Box& box : out) {
    all.include(box);
    Box there = all;
    there.inflate(blown);
    there.lo.y() = -std::numeric_limits<double>::infinity();
    box = there;
  }
  return out;
}

bool meet(const std::vector<Box>& a, const std::vector<Box>& b) {
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k)
    if (a[k].overlaps(b[k])) return true;
  return false;
}

}  // namespace

std::vector<Meeting> find_meetings(const Shot& shot, std::span<const PrimaryPlan> primaries,
                                   std::span<const ClothReach> cloths, double fastest_wind) {
  if (primaries.size() == 1) return {{{0}, {0}}};
  std::vector<std::vector<Box>> bodies, reaches;
  for (const PrimaryPlan& primary : primaries) bodies.push_back(boxes_of(shot, *primary.trajectory));
  for (const ClothReach& cloth : cloths) reaches.push_back(boxes_of(cloth, bodies[cloth.wearer], shot, fastest_wind));
  DisjointSets together(primaries.size());
  for (std::size_t a = 0; a < cloths.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (cloths[a].meets[cloths[b].wearer] != 0 && cloths[b].meets[cloths[a].wearer] != 0 &&
          meet(reaches[a], reaches[b]))
        together.join(static_cast<int>(cloths[a].wearer), static_cast<int>(cloths[b].wearer));
  std::vector<Meeting> out;
  std::vector<int> root_of;
  for (std::size_t w = 0; w < primaries.size(); ++w) {
    if (std::none_of(cloths.begin(), cloths.end(), [&](const ClothReach& c) { return c.wearer == w; })) continue;
    const int root = together.root(static_cast<int>(w));
    const auto known = std::find(root_of.begin(), root_of.end(), root);
    if (known == root_of.end())
      root_of.push_back(root), out.push_back({{w}, {w}});
    else
      out[at(known - root_of.begin())].wearers.push_back(w), out[at(known - root_of.begin())].bodies.push_back(w);
  }
  for (Meeting& meeting : out) {
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      const std::size_t w = cloths[c].wearer;
      if (std::find(meeting.wearers.begin(), meeting.wearers.end(), w) == meeting.wearers.end()) continue;
      for (std::size_t p = 0; p < primaries.size(); ++p)
        if (cloths[c].meets[p] != 0 && meet(reaches[c], bodies[p])) meeting.bodies.push_back(p);
    }
    std::sort(meeting.bodies.begin(), meeting.bodies.end());
    meeting.bodies.erase(std::unique(meeting.bodies.begin(), meeting.bodies.end()), meeting.bodies.end());
  }
  return out;
}

}  // namespace ft::inline baker

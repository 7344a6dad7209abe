#include "collision/body/room_scan.h"

#include <algorithm>
#include <limits>
#include <map>

#include "collision/body/part_distance.h"

namespace ft::inline collision {
namespace {

/// Vertices that move less are on their way to others that move more [m].
constexpr double k_least_move = 1e-3;
/// Of a part's vertices that move, so many are measured, the farthest first.
constexpr std::size_t k_most_measured = 48;

}  // namespace

struct RoomScanner::Impl {
  explicit Impl(std::shared_ptr<FeasiblePoses> given)
      : poses(std::move(given)),
        settings(poses->settings()),
        parts(poses->body().surface().parts),
        collider(poses->collider()),
        refined(at(collider.vertex_count())) {
    std::vector<Vec3> bind(at(poses->body().surface().vertex_count()));
    poses->body().bind_pose_apart(bind);
    collider.refine(bind, refined);
    shape = std::make_unique<PartSurface>(refined, collider.triangles(), collider.part_of_vertex(),
                                          static_cast<int>(parts.size()));
    all_allowed.assign(parts.size(), 1);
  }
  bool jointed(int a, int b) const { return parts[at(a)].parent == b || parts[at(b)].parent == a; }

  std::shared_ptr<FeasiblePoses> poses;
  const FeasibleSettings& settings;
  const std::vector<SurfacePart>& parts;
  const FeasibleCollider& collider;
  std::vector<Vec3> refined;  ///< the bind pose
  std::unique_ptr<PartSurface> shape;
  std::vector<char> all_allowed;
};

RoomScanner::RoomScanner(std::shared_ptr<FeasiblePoses> poses) : impl_(std::make_unique<Impl>(std::move(poses))) {}
RoomScanner::~RoomScanner() = default;

std::vector<TightPlace> RoomScanner::look(double time, std::span<double> absent_share) const {
  const Impl& m = *impl_;
  std::vector<TightPlace> out;
  std::fill(absent_share.begin(), absent_share.end(), 0.0);
  if (!m.settings.carve || m.parts.size() < 2) return out;
  std::vector<Vec3> drawn(at(m.poses->body().surface().vertex_count()));
  m.poses->body().sample(time, drawn);
  std::vector<Vec3> before(at(m.collider.vertex_count())), after(before.size());
  m.collider.refine(drawn, before);
  std::vector<char> absent(before.size());
  const bool moves = m.poses->keep(time, drawn, after, absent).moved_vertices > 0;
  const auto part_of = m.collider.part_of_vertex();
  if (!absent_share.empty()) {
    std::vector<int> count(m.parts.size(), 0);
    for (std::size_t v = 0; v < absent.size(); ++v) ++count[at(part_of[v])], absent_share[at(part_of[v])] += absent[v];
    for (std::size_t p = 0; p < count.size(); ++p) absent_share[p] /= std::max(1, count[p]);
  }
  if (!moves) return out;
  const std::size_t part_count = m.parts.size();
  std::vector<std::vector<std::pair<double, int>>> moved(part_count);  // (-distance moved, vertex)
  std::vector<Box> boxes(part_count);
  for (std::size_t v = 0; v < before.size(); ++v) {
    const std::size_t part = at(part_of[v]);
    boxes[part].include(before[v]);
    const double move = (after[v] - before[v]).norm();
    if (move > k_least_move) moved[part].emplace_back(-move, static_cast<int>(v));
  }
  std::vector<TriangleTree> trees(part_count);
  std::map<std::pair<int, int>, TightPlace> found;
  for (int a = 0; a < static_cast<int>(part_count); ++a) {
    auto& mine = moved[at(a)];
    if (mine.empty()) continue;
    std::sort(mine.begin(), mine.end());
    mine.resize(std::min(mine.size(), k_most_measured));
    for (const auto& [move, v] : mine) {
      // Parts that touch in the bind pose are named only where no other is to blame.
      TightPlace best;
      best.clearance = m.settings.gap;
      bool best_apart = false;
      for (int b = 0; b < static_cast<int>(part_count); ++b) {
        if (b == a || m.parts[at(b)].sheet || m.jointed(a, b) || m.shape->tree(b).empty()) continue;
        const bool apart = m.collider.kept_apart(a, b);
        if (best_apart && !apart) continue;
        Box near = boxes[at(b)];
        near.inflate(m.settings.gap);
        if (!((near.lo.array() <= before[at(v)].array()).all() && (before[at(v)].array() <= near.hi.array()).all()))
          continue;
        if (trees[at(b)].empty()) {
          trees[at(b)] = m.shape->tree(b);
          trees[at(b)].refit(before, m.shape->triangles());
        }
        const int one[1] = {b};
        int hint = -1;
        const double reach = std::isfinite(m.shape->depth_limit(b)) ? std::max(m.shape->depth_limit(b), m.settings.gap)
                                                                    : near.size().norm();
        const auto answer = m.shape->distance(before[at(v)], one, m.all_allowed, reach, {before, trees}, hint);
        if (!answer || answer->distance >= m.settings.gap) continue;
        if (best.part_a < 0 || (apart && !best_apart) || answer->distance < best.clearance) {
          best = {a, b, answer->distance, before[at(v)]};
          best_apart = apart;
        }
      }
      if (best.part_a < 0) continue;
      auto [entry, is_new] = found.try_emplace({best.part_a, best.part_b}, best);
      if (!is_new && best.clearance < entry->second.clearance) entry->second = best;
    }
  }
  for (const auto& [parts, place] : found) out.push_back(place);
  return out;
}

}  // namespace ft::inline collision

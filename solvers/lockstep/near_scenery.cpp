#include "solvers/lockstep/near_scenery.h"

#include <algorithm>

namespace ft::inline solvers {
namespace {

/// What is covered is larger than what is asked for: cords that move on a little need no new choice [m].
constexpr double k_more = 0.05;

bool contains(const Box& outer, const Box& inner) {
  return (outer.lo.array() <= inner.lo.array()).all() && (inner.hi.array() <= outer.hi.array()).all();
}

}  // namespace

NearScenery::NearScenery(const Scenery& scenery, int point_count, std::span<const Triangle> cords)
    : scenery_(scenery), point_count_(point_count), cords_(cords) {}

void NearScenery::cover(const Box& box) {
  if (contains(covered_, box)) return;
  covered_ = box;
  covered_.inflate(k_more);
  std::vector<int> number(at(scenery_.vertex_count()), -1);
  std::vector<Triangle> chosen;
  for (const Triangle& t : scenery_.triangles()) {
    Box swept;
    for (const int v : t) {
      swept.include(scenery_.start(v));
      swept.include(Vec3(scenery_.start(v) + scenery_.way(v)));
    }
    if (!swept.overlaps(covered_)) continue;
    chosen.push_back(t);
    for (const int v : t) number[at(v)] = 0;
  }
  vertices_.clear();
  largest_way_ = 0;
  for (int v = 0; v < scenery_.vertex_count(); ++v) {
    if (number[at(v)] < 0) continue;
    number[at(v)] = static_cast<int>(vertices_.size());
    vertices_.push_back(v);
    largest_way_ = std::max(largest_way_, scenery_.way(v).norm());
  }
  for (Triangle& t : chosen)
    for (int& v : t) v = point_count_ + number[at(v)];
  if (finder_ && chosen == triangles_) return;
  triangles_ = std::move(chosen);
  finder_.reset();
  if (!triangles_.empty()) finder_.emplace(point_count_, cords_, static_cast<int>(vertices_.size()), triangles_);
  arranged_ = false;
}

void NearScenery::find(std::span<const VertexBox> boxes, std::span<const Vec3> places, PairList& out) {
  out = {};
  if (!finder_) return;
  if (!arranged_) finder_->arrange(places);
  arranged_ = true;
  finder_->find(boxes, false, out);
}

}  // namespace ft::inline solvers

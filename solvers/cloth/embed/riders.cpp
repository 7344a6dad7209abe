#include "solvers/cloth/embed/riders.h"

#include <algorithm>

#include "baker/core/check.h"
#include "baker/core/corner_uvs.h"
#include "baker/core/parallel.h"
#include "baker/core/rigid.h"
#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/pins.h"
#include "solvers/cloth/model/sewing.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 4096;
/// What is drawn in lies so many times nearer. Much more is lost in the single precision of a cache.
constexpr double k_nearer = 1.0 / 8;

Mat3 frame_of(const std::array<int, 3>& t, std::span<const Vec3> x) {
  return triangle_frame(x[at(t[0])], x[at(t[1])], x[at(t[2])]);
}

/// group_at: of each vertex that moves; -1: none.
std::vector<std::vector<Riders::Spoke>> spokes_of(const Mesh& moves, std::span<const int> group_at,
                                                  std::size_t group_count) {
  std::vector<std::vector<Riders::Spoke>> out(group_count);
  for (const Edge& e : unique_edges(triangulate(moves)))
    for (const auto& [from, to] : {std::pair(e[0], e[1]), std::pair(e[1], e[0])})
      if (const int g = group_at[at(from)]; g >= 0)
        out[at(g)].push_back({to, (moves.positions[at(to)] - moves.positions[at(from)]).normalized()});
  return out;
}

Riders riders_of(const ClothGarment& given, const CoarseGarment& coarse) {
  Riders out;
  out.name = given.name;
  out.mesh = given.mesh;
  out.kept = coarse.kept;
  out.places = coarse.places;
  const std::vector<Vec3>& x = given.mesh.positions;
  const std::vector<Vec3>& moved = coarse.garment.mesh.positions;
  std::vector<int> group_at(moved.size(), -1);
  for (std::size_t v = 0; v < x.size(); ++v) {
    const int into = coarse.into[v];
    out.group.push_back(-1);
    out.offset.push_back(Vec3::Zero());
    out.around.push_back(Vec3::Zero());
    if (coarse.kept[at(into)] == static_cast<int>(v)) continue;
    int& group = group_at[at(into)];
    if (group < 0) {
      group = static_cast<int>(out.into.size());
      out.into.push_back(into);
    }
    out.group.back() = group;
    const CoarsenedMesh::Place& place = coarse.places[v];
    out.offset.back() = frame_of(place.vertex, moved).transpose() * (x[v] - place.of(moved));
    out.around.back() = x[v] - moved[at(into)];
  }
  out.spokes = spokes_of(coarse.garment.mesh, group_at, out.group_count());
  out.alone.assign(out.group_count(), 1);
  for (const Edge& e : unique_edges(triangulate(given.mesh))) {
    const int a = out.group[at(e[0])], b = out.group[at(e[1])];
    if (a >= 0 && b >= 0 && a != b) out.alone[at(a)] = out.alone[at(b)] = 0;
  }
  return out;
}

Riders all_move(const ClothGarment& given) {
  CoarseGarment same{given, {}, {}, {}};
  for (int v = 0; v < given.mesh.vertex_count(); ++v) {
    same.kept.push_back(v);
    same.places.push_back({{v, v, v}, {1, 0, 0}});
    same.into.push_back(v);
  }
  return riders_of(given, same);
}

/// Edges of the given garment with their lengths at rest, as every reader of its caches takes them.
RestEdges rest_of(const ClothGarment& garment) {
  const std::vector<Triangle> triangles = triangulate(garment.mesh);
  RestEdges out = rest_edges(garment.mesh.positions, triangles);
  if (!(garment.pattern_scale > 0)) return out;
  const ClothPiece piece{0, garment.mesh.vertex_count(), garment.fabric, garment.pattern_scale};
  lengths_from_pattern(
      make_cloth_topology(garment.mesh.positions, triangles, std::span(&piece, 1), corner_uvs(garment.mesh, triangles)),
      out);
  return out;
}

}  // namespace

Mat3 Riders::turn_of(std::size_t in_group, std::span<const Vec3> moved) const {
  Mat3 sum = Mat3::Zero();
  for (const Spoke& spoke : spokes[in_group])
    sum += (moved[at(spoke.end)] - moved[at(into[in_group])]).normalized() * spoke.direction.transpose();
  return nearest_rotation(sum);
}

void Riders::place(std::span<const Vec3> moved, std::span<const double> drawn_in, std::span<Vec3> out) const {
  CHECK(moved.size() == kept.size() && drawn_in.size() == group_count() && out.size() == places.size());
  const auto turns = [&](std::size_t g) { return alone[g] != 0 || drawn_in[g] > 0; };
  std::vector<Mat3> turn(group_count());
  for (std::size_t g = 0; g < turn.size(); ++g)
    if (turns(g)) turn[g] = turn_of(g, moved);
  parallel_for(out.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      if (group[v] < 0) {
        out[v] = moved[at(places[v].vertex[0])];
      } else if (const auto g = at(group[v]); turns(g)) {
        out[v] = moved[at(into[g])] + (drawn_in[g] > 0 ? k_nearer : 1) * (turn[g] * around[v]);
      } else {
        out[v] = places[v].of(moved) + frame_of(places[v].vertex, moved) * offset[v];
      }
    }
  });
}

void AllRiders::add(const ClothGarment& given, const CoarseGarment* coarse) {
  Riders riders = coarse ? riders_of(given, *coarse) : all_move(given);
  const int first = static_cast<int>(vertex_count());
  for (const int g : riders.group) group_.push_back(g < 0 ? -1 : g + static_cast<int>(group_count_));
  for (Triangle t : triangulate(given.mesh)) {
    for (int& v : t) v += first;
    triangles_.push_back(t);
    if (std::any_of(t.begin(), t.end(), [&](int v) { return rides(v); })) riding_.push_back(t);
  }
  const RestEdges own = rest_of(given);
  for (std::size_t k = 0; k < own.edges.size(); ++k) {
    rest_edges_.edges.push_back({own.edges[k][0] + first, own.edges[k][1] + first});
    rest_edges_.lengths.push_back(own.lengths[k]);
  }
  for (Stitch s : given.mesh.stitches) {
    s.vertex += first, s.edge[0] += first, s.edge[1] += first;
    stitches_.push_back(s);
  }
  riders.first_group = group_count_;
  group_count_ += riders.group_count();
  self_collides_.push_back(given.self_collision);
  first_vertex_.push_back(vertex_count() + given.mesh.positions.size());
  garments_.push_back(std::move(riders));
}

void AllRiders::finish() {
  sewn_ = SewnPairs(static_cast<int>(vertex_count()), stitches_, triangles_);
  stitches_ = {};
}

int AllRiders::garment_of(int vertex) const {
  return static_cast<int>(std::upper_bound(first_vertex_.begin(), first_vertex_.end(), at(vertex)) -
                          first_vertex_.begin()) -
         1;
}

void AllRiders::to_given(Incident& incident) const {
  const auto garment = std::find_if(garments_.begin(), garments_.end(),
                                    [&](const Riders& riders) { return riders.name == incident.system; });
  if (garment != garments_.end() && incident.vertex >= 0) incident.vertex = garment->kept[at(incident.vertex)];
}

bool AllRiders::counts(const Crossing& own) const {
  return self_collides_[at(garment_of(own.edge[0]))] && self_collides_[at(garment_of(own.triangle[0]))] &&
         !sewn_.together(own);
}

RidingCrossings AllRiders::crossings(std::span<const Vec3> x, const CheckedSurface& collider) const {
  RidingCrossings out;
  const auto any_rides = [&](std::span<const int> vertices) {
    return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return rides(v); });
  };
  CheckedSurface riding(riding_);
  riding.move(x);
  out.with_body = crossings_between(riding, collider);
  std::erase_if(out.with_body, [&](const Crossing& c) {  // an edge of two that move is not ours
    return !any_rides(c.edge_of_first ? std::span<const int>(c.edge) : c.triangle);
  });
  std::vector<Triangle> near;
  for (const Triangle& t : triangles_) {
    const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
    bool meets = false;
    riding.tree().for_each_near(TreeBox::around(a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)),
                                [&](int) { meets = true; });
    if (meets) near.push_back(t);
  }
  out.own = crossings_within(x, near);
  std::erase_if(out.own,
                [&](const Crossing& c) { return (!any_rides(c.edge) && !any_rides(c.triangle)) || !counts(c); });
  return out;
}

RidingCrossings AllRiders::all_crossings(std::span<const Vec3> x, const CheckedSurface& collider) const {
  CheckedSurface cloth(triangles_);
  cloth.move(x);
  RidingCrossings out{crossings_between(cloth, collider), crossings_within(cloth)};
  std::erase_if(out.own, [&](const Crossing& c) { return !counts(c); });
  return out;
}

void AllRiders::draw_in(const RidingCrossings& crossings, std::vector<double>& drawn_in) const {
  const auto draw = [&](std::span<const int> vertices) {
    for (const int v : vertices)
      if (rides(v)) drawn_in[at(group_[at(v)])] = 1;
  };
  for (const Crossing& c : crossings.with_body) draw(c.edge_of_first ? std::span<const int>(c.edge) : c.triangle);
  for (const Crossing& c : crossings.own) draw(c.edge), draw(c.triangle);
}

}  // namespace ft::inline solvers

#include "solvers/cloth/solve/way_out.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace ft::inline solvers {
namespace {

/// How far beyond the other a pair is pulled [m]: contact takes over from there.
constexpr double k_beyond = 2e-4;
/// And how fast at most [m/s].
constexpr double k_speed = 0.5;
/// How stiff its spring is, of a contact's: what a fabric whose rest shape crosses itself insists on gives way. With 10
/// a collar kept the last two crossings for good, from 30 to 100 it came out within two frames, with 200 in seven [1].
constexpr double k_stiffness = 50;
/// Crossings that may come in a place where what is cut off gets smaller: of a row of vertices one has to be the first.
constexpr int k_detour = 4;

bool has(const Triangle& t, int v) {
  return t[0] == v || t[1] == v || t[2] == v;
}

Stencil of_vertex(int v, const Triangle& t) {
  return {{v, t[0], t[1], t[2]}};
}

Stencil of_edges(Edge a, Edge b) {
  if (a[0] > a[1]) std::swap(a[0], a[1]);
  if (b[0] > b[1]) std::swap(b[0], b[1]);
  if (b < a) std::swap(a, b);
  return {{a[0], a[1], b[0], b[1]}};
}

void sort_unique(std::vector<Stencil>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

int root(std::vector<int>& parent, int v) {
  while (parent[at(v)] != v) v = parent[at(v)] = parent[at(parent[at(v)])];
  return v;
}

/// The lower number stays the root.
void join(std::vector<int>& parent, int a, int b) {
  a = root(parent, a), b = root(parent, b);
  if (a != b) parent[at(std::max(a, b))] = std::min(a, b);
}

}  // namespace

PairTerm Pull::term() const {
  PairTerm out;
  out.vertex = vertex;
  for (std::size_t k = 0; k < 4; ++k) out.weight[k] = static_cast<float>(weight[k]);
  out.stiffness = (stiffness * normal * normal.transpose()).cast<float>();
  return out;
}

bool WayOut::is_open(PairKind kind, const Stencil& pair) const {
  if (beside.empty()) return false;
  for (const int v : pair.v)
    if (at(v) >= beside.size() || beside[at(v)] == 0) return false;
  if (kind == PairKind::k_vertex_face)
    return std::binary_search(open.vertex_face.begin(), open.vertex_face.end(), pair);
  const Stencil ordered = of_edges({pair.v[0], pair.v[1]}, {pair.v[2], pair.v[3]});
  return std::binary_search(open.edge_edge.begin(), open.edge_edge.end(), ordered);
}

void WayOutFinder::learn_mesh() {
  if (edges_of_.row_count() > 0) return;
  triangles_of_ = vertex_triangles(model_.vertex_count(), model_.triangles);
  const auto& edges = model_.rest_edges.edges;
  edges_of_.start.assign(at(model_.vertex_count()) + 1, 0);
  for (const Edge& e : edges)
    for (const int v : e) ++edges_of_.start[at(v) + 1];
  std::partial_sum(edges_of_.start.begin(), edges_of_.start.end(), edges_of_.start.begin());
  edges_of_.items.resize(2 * edges.size());
  std::vector<int> next(edges_of_.start.begin(), edges_of_.start.end() - 1);
  for (std::size_t k = 0; k < edges.size(); ++k)
    for (const int v : edges[k]) edges_of_.items[at(next[at(v)]++)] = static_cast<int>(k);
}

/// Rank of an edge, -1 where it has no length at rest.
int WayOutFinder::edge_of(int a, int b) const {
  for (const int e : edges_of_.row(a)) {
    const Edge& edge = model_.rest_edges.edges[at(e)];
    if (edge[0] == b || edge[1] == b) return e;
  }
  return -1;
}

int WayOutFinder::face_of(const Triangle& t) const {
  for (const int f : triangles_of_.row(t[0]))
    if (model_.triangles[at(f)] == t) return f;
  return -1;
}

bool WayOutFinder::crosses(int edge, int face) const {
  return std::binary_search(crossing_.begin(), crossing_.end(), place(edge, face));
}

void WayOutFinder::cut_regions(std::span<const Crossing> crossings) {
  const auto& edges = model_.rest_edges.edges;
  crossing_.clear();
  cut_.assign(edges.size(), 0);
  for (const Crossing& c : crossings) {
    const int e = edge_of(c.edge[0], c.edge[1]), f = face_of(c.triangle);
    if (e < 0 || f < 0) continue;
    crossing_.push_back(place(e, f));
    cut_[at(e)] = 1;
  }
  std::sort(crossing_.begin(), crossing_.end());
  region_.resize(at(model_.vertex_count()));
  std::iota(region_.begin(), region_.end(), 0);
  for (std::size_t k = 0; k < edges.size(); ++k)
    if (cut_[k] == 0) join(region_, edges[k][0], edges[k][1]);
  for (const SeamPoint& s : model_.seams)
    for (const int v : s.edge) join(region_, s.vertex, v);
  area_.assign(region_.size(), 0.0);
  for (int v = 0; v < model_.vertex_count(); ++v) {
    region_[at(v)] = root(region_, v);
    area_[at(region_[at(v)])] += model_.contact.area[at(v)];
  }
}

/// The end that is cut off, -1 where none is.
int WayOutFinder::wrong_end(const Edge& edge) const {
  const int a = region_[at(edge[0])], b = region_[at(edge[1])];
  if (a == b) return -1;
  return area_[at(a)] < area_[at(b)] || (area_[at(a)] == area_[at(b)] && a > b) ? edge[0] : edge[1];
}

/// A vertex of an edge that crosses a face.
void WayOutFinder::look_at_vertex(int v, int face, bool is_wrong) {
  const Triangle& t = model_.triangles[at(face)];
  if (has(t, v)) return;
  int through = 0, others = 0;
  for (const int e : edges_of_.row(v)) {
    const Edge& edge = model_.rest_edges.edges[at(e)];
    if (has(t, edge[0]) || has(t, edge[1])) continue;
    ++(crosses(e, face) ? through : others);
  }
  if (!is_wrong && through <= others) return;
  out_->open.vertex_face.push_back(of_vertex(v, t));
  pulled_.vertex_face.push_back(of_vertex(v, t));
}

/// An edge that crosses a face, and an edge of that face.
void WayOutFinder::look_at_edges(int e, int f, int face) {
  const Edge &a = model_.rest_edges.edges[at(e)], &b = model_.rest_edges.edges[at(f)];
  if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) return;
  int through = 0, others = 0;
  const auto count = [&](int edge, int beside) {
    const Edge& of = model_.rest_edges.edges[at(beside)];
    for (const int t : triangles_of_.row(of[0])) {
      const Triangle& triangle = model_.triangles[at(t)];
      const Edge& over = model_.rest_edges.edges[at(edge)];
      if (!has(triangle, of[1]) || has(triangle, over[0]) || has(triangle, over[1])) continue;
      ++(crosses(edge, t) ? through : others);
    }
  };
  count(e, f);
  count(f, e);
  // Whether the contour would move away from what it cuts off.
  const Triangle& t = model_.triangles[at(face)];
  const int r0 = region_[at(t[0])], r1 = region_[at(t[1])], r2 = region_[at(t[2])];
  int smallest = r0;
  for (const int r : {r1, r2})
    if (area_[at(r)] < area_[at(smallest)]) smallest = r;
  const bool parted = r0 != r1 || r0 != r2;
  const bool touches_small = region_[at(b[0])] == smallest || region_[at(b[1])] == smallest;
  const bool inwards = parted && touches_small, outwards = parted && !touches_small;
  if (through < others && !inwards) return;
  if (through == others && outwards) return;
  out_->open.edge_edge.push_back(of_edges(a, b));
  if (through > others) pulled_.edge_edge.push_back(of_edges(a, b));
}

/// What is cut off may lie over another face than its edge goes through, and would rest on it: it may pass the faces
/// around, too, and its edge their edges.
void WayOutFinder::open_around(int wrong, int e, int face) {
  const Edge& edge = model_.rest_edges.edges[at(e)];
  for (const int v : model_.triangles[at(face)])
    for (const int f : triangles_of_.row(v)) {
      const Triangle& t = model_.triangles[at(f)];
      if (has(t, edge[0]) || has(t, edge[1])) continue;
      out_->open.vertex_face.push_back(of_vertex(wrong, t));
      for (std::size_t k = 0; k < 3; ++k) out_->open.edge_edge.push_back(of_edges(edge, {t[k], t[(k + 1) % 3]}));
    }
}

void WayOutFinder::make_pulls() {
  const auto make = [&](PairKind kind, const std::vector<Stencil>& pairs) {
    for (const Stencil& s : pairs) {
      const std::array<Vec3, 4> x = gather(x_, s);
      const PairGeometry g = pair_geometry(kind, x);
      Pull pull;
      pull.vertex = s.v;
      pull.weight = g.weight;
      double from = 0;
      if (kind == PairKind::k_vertex_face) {
        const Vec3 normal = (x[2] - x[1]).cross(x[3] - x[1]).normalized();
        const double side = normal.dot(x[0] - x[1]);
        pull.normal = side > 0 ? Vec3(-normal) : normal;
        from = -std::abs(side);
      } else {
        pull.normal = -g.normal;
        from = -g.distance;
      }
      if (!pull.normal.allFinite() || pull.normal.isZero()) continue;
      pull.goal = std::min(k_beyond, from + k_speed * h_);
      double area = 0;
      for (const int v : s.v) area += 0.25 * model_.contact.area[at(v)];
      pull.stiffness = k_stiffness * model_.contact.stiffness_per_area * area;
      out_->pulls.push_back(pull);
    }
  };
  make(PairKind::k_vertex_face, pulled_.vertex_face);
  make(PairKind::k_edge_edge, pulled_.edge_edge);
}

void WayOutFinder::mark_beside() {
  out_->beside.assign(at(model_.vertex_count()), 0);
  for (const auto* pairs : {&out_->open.vertex_face, &out_->open.edge_edge})
    for (const Stencil& s : *pairs)
      for (const int v : s.v) out_->beside[at(v)] = 1;
}

/// Of the crossings that have come those in places where more have come than gone. What has changed in one place has
/// vertices in common.
std::vector<Crossing> WayOutFinder::find_growth(std::span<const Crossing> after) {
  std::vector<Crossing> created, removed;
  std::set_difference(after.begin(), after.end(), before_.begin(), before_.end(), std::back_inserter(created));
  if (created.empty()) return {};
  std::set_difference(before_.begin(), before_.end(), after.begin(), after.end(), std::back_inserter(removed));
  place_.resize(at(model_.vertex_count()));
  std::iota(place_.begin(), place_.end(), 0);
  for (const auto* changed : {&created, &removed})
    for (const Crossing& c : *changed) {
      join(place_, c.edge[0], c.edge[1]);
      for (const int v : c.triangle) join(place_, c.edge[0], v);
    }
  growth_.assign(place_.size(), 0);
  for (const Crossing& c : created) ++growth_[at(root(place_, c.edge[0]))];
  for (const Crossing& c : removed) --growth_[at(root(place_, c.edge[0]))];
  if (after.size() <= before_.size() + k_detour) {
    std::vector<int> heals;
    for (const Crossing& c : removed)
      if (wrong_end(c.edge) >= 0) heals.push_back(root(place_, c.edge[0]));
    std::sort(heals.begin(), heals.end());
    heals.erase(std::unique(heals.begin(), heals.end()), heals.end());
    for (const int place : heals) growth_[at(place)] -= k_detour;
  }
  std::erase_if(created, [&](const Crossing& c) { return growth_[at(root(place_, c.edge[0]))] <= 0; });
  return created;
}

bool WayOutFinder::grows(std::span<const Crossing> after) {
  return !find_growth(after).empty();
}

ContactPairs WayOutFinder::close_growing(std::span<const Crossing> after, WayOut& out) {
  const std::vector<Crossing> created = find_growth(after);
  if (created.empty()) return {};
  const auto grows = [&](int v) { return growth_[at(root(place_, v))] > 0; };
  ContactPairs closed;
  const auto take = [](std::vector<Stencil>& open, const Stencil& pair, std::vector<Stencil>& to) {
    const auto found = std::lower_bound(open.begin(), open.end(), pair);
    if (found == open.end() || !(*found == pair)) return;
    to.push_back(pair);
    open.erase(found);
  };
  for (const Crossing& c : created) {
    for (const int v : c.edge) take(out.open.vertex_face, of_vertex(v, c.triangle), closed.vertex_face);
    for (std::size_t k = 0; k < 3; ++k)
      take(out.open.edge_edge, of_edges(c.edge, {c.triangle[k], c.triangle[(k + 1) % 3]}), closed.edge_edge);
  }
  if (closed.vertex_face.empty() && closed.edge_edge.empty()) {
    const auto take_all = [&](std::vector<Stencil>& open, std::vector<Stencil>& to) {
      const auto in_place = [&](const Stencil& s) { return std::any_of(s.v.begin(), s.v.end(), grows); };
      for (const Stencil& s : open)
        if (in_place(s)) to.push_back(s);
      std::erase_if(open, in_place);
    };
    take_all(out.open.vertex_face, closed.vertex_face);
    take_all(out.open.edge_edge, closed.edge_edge);
  }
  sort_unique(closed.vertex_face);
  sort_unique(closed.edge_edge);
  return closed;
}

void WayOutFinder::find(std::span<const Vec3> x, std::span<const Crossing> crossings, double h, WayOut& out) {
  out = {};
  before_.assign(crossings.begin(), crossings.end());
  if (crossings.empty()) return;
  learn_mesh();
  x_ = x, h_ = h, out_ = &out;
  pulled_ = {};
  cut_regions(crossings);
  for (const Crossing& c : crossings) {
    const int e = edge_of(c.edge[0], c.edge[1]), f = face_of(c.triangle);
    if (e < 0 || f < 0) continue;
    const int wrong = wrong_end(c.edge);
    if (wrong < 0)
      out.unexplained.push_back(c);
    else
      open_around(wrong, e, f);
    for (const int v : c.edge) look_at_vertex(v, f, v == wrong);
    for (std::size_t k = 0; k < 3; ++k) {
      const int edge = edge_of(c.triangle[k], c.triangle[(k + 1) % 3]);
      if (edge >= 0) look_at_edges(e, edge, f);
    }
  }
  sort_unique(out.open.vertex_face);
  sort_unique(out.open.edge_edge);
  sort_unique(pulled_.vertex_face);
  sort_unique(pulled_.edge_edge);
  make_pulls();
  mark_beside();
}

}  // namespace ft::inline solvers

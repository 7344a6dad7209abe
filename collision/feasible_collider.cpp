// See feasible_collider.h. The parts are walked from the largest to the smallest, each against all larger ones, which are final
// by then. One part: project its vertices, smooth the displacements so that no triangle tears, project again, then lift edges
// that sag into a curved larger part. Nothing is remembered between calls.
#include "collision/feasible_collider.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/mesh_refine.h"
#include "collision/part_distance.h"

namespace ft {
namespace {

constexpr int k_project_rounds = 3;     ///< rounds of projection, so that a vertex between two parts settles
constexpr int k_smooth_sweeps = 2;      ///< Laplacian sweeps of the displacement between rounds
constexpr int k_sag_rounds = 3;         ///< rounds of lifting edges
constexpr double k_sag_share = 0.85;    ///< share of the gap that edges' middles must keep [1]
constexpr double k_touching_zone = 30e-3;  ///< bind distance from which on vertices of touching parts keep the full gap [m]
constexpr std::size_t k_block = 256;    ///< vertices per parallel block
constexpr double k_free = -std::numeric_limits<double>::infinity();

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// A larger shell that a part may have to leave: its parts, largest first.
struct Opponent {
  int shell = -1;
  std::vector<int> parts;
};

/// What never changes about one part as the one that gives way. Vertices are local, in the part's own numbering.
struct Yielding {
  std::vector<int> vertices;         ///< refined vertices (representatives), ascending
  std::vector<Edge> edges;           ///< local
  Adjacency neighbours;              ///< local
  std::vector<Opponent> opponents;
  std::vector<char> allowed;         ///< per part: larger and not jointed
  /// Per part that is touched in the bind pose: how far from it each vertex must be [m]; from others the gap.
  std::vector<std::pair<int, std::vector<double>>> touching;

  const std::vector<double>* touching_part(int part) const {
    for (const auto& [other, required] : touching)
      if (other == part) return &required;
    return nullptr;
  }
};

Adjacency neighbours_of(int vertex_count, std::span<const Edge> edges) {
  std::vector<std::array<int, 2>> both;
  for (const Edge& e : edges) both.insert(both.end(), {{e[0], e[1]}, {e[1], e[0]}});
  std::sort(both.begin(), both.end());
  Adjacency out;
  out.start.assign(at(vertex_count) + 1, 0);
  for (const auto& b : both) ++out.start[at(b[0]) + 1], out.items.push_back(b[1]);
  std::partial_sum(out.start.begin(), out.start.end(), out.start.begin());
  return out;
}

bool overlap(const TreeBox& a, const TreeBox& b, double gap) {
  for (int k = 0; k < 3; ++k)
    if (a.lo[k] > b.hi[k] + gap || b.lo[k] > a.hi[k] + gap) return false;
  return true;
}

}  // namespace

struct FeasibleCollider::Impl {
  FeasibleSettings settings;
  RefinedMesh mesh;
  std::vector<int> part_of_vertex;
  std::vector<SurfacePart> parts;
  std::vector<int> by_size;  ///< parts, largest first
  std::unique_ptr<PartSurface> surface;
  std::vector<Yielding> yielding;  ///< per part
  std::vector<int> copies;         ///< vertices that follow their representative

  /// Positions and trees of one evaluation.
  struct Scratch {
    std::span<Vec3> x;
    std::vector<TriangleTree> trees;
  };
  struct Contact {
    Vec3 normal;
    double distance = 0;  ///< before the vertex was moved [m]
    bool near = false;
  };

  bool jointed(int a, int b) const { return parts[at(a)].parent == b || parts[at(b)].parent == a; }
  void add_refined_parts(const Surface& drawn, std::span<const int> rank);
  void find_opponents(std::span<const int> rank);
  void find_touching(std::span<const Vec3> bind);
  std::vector<Opponent> opponents_now(const Yielding& part, Scratch& scratch) const;
  double required(const Yielding& part, int local, int other) const;
  bool push_out(const Yielding& part, int a, int b, std::span<const Opponent> opponents, const Scratch& scratch,
                Vec3& point, Contact& contact, std::span<int> hints) const;
  int deepest_opponent(const Yielding& part, const Vec3& point, const Scratch& scratch) const;
  void give_way(int part, Scratch& scratch) const;
  void lift_edges(const Yielding& part, std::span<const Opponent> opponents, std::vector<Contact>& contacts,
                  Scratch& scratch) const;
};

void FeasibleCollider::Impl::add_refined_parts(const Surface& drawn, std::span<const int> rank) {
  part_of_vertex = drawn.part_of_vertex;
  for (const RefinedMesh::Blend& blend : mesh.blends) {
    const int p = part_of_vertex[at(blend.a)], q = part_of_vertex[at(blend.b)];
    part_of_vertex.push_back(rank[at(p)] <= rank[at(q)] ? p : q);
  }
}

void FeasibleCollider::Impl::find_opponents(std::span<const int> rank) {
  const auto representative = surface->representative();
  std::vector<int> local(representative.size(), -1);
  yielding.resize(parts.size());
  for (int v = 0; v < static_cast<int>(representative.size()); ++v) {
    if (representative[at(v)] != v) {
      copies.push_back(v);
      continue;
    }
    auto& vertices = yielding[at(part_of_vertex[at(v)])].vertices;
    local[at(v)] = static_cast<int>(vertices.size());
    vertices.push_back(v);
  }
  for (const Edge& e : unique_edges(surface->triangles())) {
    const int part = part_of_vertex[at(e[0])];
    if (e[0] != e[1] && part == part_of_vertex[at(e[1])])
      yielding[at(part)].edges.push_back({local[at(e[0])], local[at(e[1])]});
  }
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    Yielding& part = yielding[at(p)];
    part.neighbours = neighbours_of(static_cast<int>(part.vertices.size()), part.edges);
    part.allowed.assign(parts.size(), 0);
    for (const int other : by_size) {
      if (rank[at(other)] >= rank[at(p)]) break;
      if (jointed(p, other) || surface->tree(other).empty()) continue;
      part.allowed[at(other)] = 1;
      const auto found = std::find_if(part.opponents.begin(), part.opponents.end(),
                                      [&](const Opponent& o) { return o.shell == surface->shell(other); });
      if (found != part.opponents.end())
        found->parts.push_back(other);
      else
        part.opponents.push_back({surface->shell(other), {other}});
    }
  }
}

void FeasibleCollider::Impl::find_touching(std::span<const Vec3> bind) {
  std::vector<TriangleTree> trees;
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) trees.push_back(surface->tree(p));
  for (int p = 0; p < static_cast<int>(parts.size()); ++p) {
    Yielding& part = yielding[at(p)];
    if (part.vertices.empty()) continue;
    Box box;
    for (const int v : part.vertices) box.include(bind[at(v)]);
    const TreeBox own = TreeBox::around(box.lo, box.hi);
    for (const Opponent& opponent : part.opponents)
      for (const int other : opponent.parts) {
        if (!overlap(own, trees[at(other)].box(), settings.gap)) continue;
        std::vector<double> keep(part.vertices.size(), settings.gap);
        const double reach = std::max({surface->depth_limit(other), settings.gap, k_touching_zone});
        const int one[1] = {other};
        bool touches = false;
        int hint = -1;
        for (std::size_t i = 0; i < keep.size(); ++i) {
          const auto answer = surface->distance(bind[at(part.vertices[i])], one, part.allowed, reach, {bind, trees}, hint);
          if (!answer || answer->distance >= k_touching_zone) continue;
          keep[i] = answer->distance <= 0 ? k_free : settings.gap - 2 * (k_touching_zone - answer->distance);
          touches = touches || answer->distance < settings.gap;
        }
        if (touches) part.touching.emplace_back(other, std::move(keep));
      }
  }
}

/// Opponents whose boxes, grown by the gap, meet the part's now; their trees are brought up to date.
std::vector<Opponent> FeasibleCollider::Impl::opponents_now(const Yielding& part, Scratch& scratch) const {
  std::vector<Opponent> out;
  if (part.vertices.empty()) return out;
  Box box;
  for (const int v : part.vertices) box.include(scratch.x[at(v)]);
  const TreeBox own = TreeBox::around(box.lo, box.hi);
  for (const Opponent& opponent : part.opponents) {
    Opponent now{opponent.shell, {}};
    for (const int other : opponent.parts) {
      TriangleTree& tree = scratch.trees[at(other)];
      if (tree.empty()) {
        tree = surface->tree(other);
        tree.refit(scratch.x, surface->triangles());
      }
      if (overlap(own, tree.box(), settings.gap)) now.parts.push_back(other);
    }
    if (!now.parts.empty()) out.push_back(std::move(now));
  }
  return out;
}

double FeasibleCollider::Impl::required(const Yielding& part, int local, int other) const {
  const std::vector<double>* keep = part.touching_part(other);
  return keep == nullptr ? settings.gap : (*keep)[at(local)];
}

/// Moves point (vertex a of the part, or the middle of a and b) out of every opponent; true when it moved. contact tells about
/// the nearest opponent.
bool FeasibleCollider::Impl::push_out(const Yielding& part, int a, int b, std::span<const Opponent> opponents,
                                      const Scratch& scratch, Vec3& point, Contact& contact, std::span<int> hints) const {
  bool moved = false;
  contact.near = false;
  for (std::size_t k = 0; k < opponents.size(); ++k) {
    const Opponent& opponent = opponents[k];
    double reach = 2 * settings.gap;
    bool inside_box = false;
    for (const int other : opponent.parts) {
      if (required(part, a, other) == k_free) continue;
      const double d2 = scratch.trees[at(other)].box().squared_distance(point);
      if (d2 <= settings.gap * settings.gap) inside_box = true;
      if (d2 == 0) reach = std::max(reach, surface->depth_limit(other));
    }
    if (!inside_box) continue;
    const auto answer = surface->distance(point, opponent.parts, part.allowed, reach, {scratch.x, scratch.trees}, hints[k]);
    if (!answer) continue;
    double keep = required(part, a, answer->part);
    if (b >= 0) {
      if (keep < settings.gap || required(part, b, answer->part) < settings.gap) continue;
      keep = k_sag_share * settings.gap;
    }
    if (answer->distance < 2 * settings.gap && (!contact.near || answer->distance < contact.distance))
      contact = {answer->normal, answer->distance, true};
    if (answer->distance >= keep) continue;
    point += (keep - answer->distance) * answer->normal;
    moved = true;
  }
  return moved;
}

/// Edges whose ends keep the gap may still cut a larger part's curve: their middles are lifted, and both ends with them.
void FeasibleCollider::Impl::lift_edges(const Yielding& part, std::span<const Opponent> opponents,
                                        std::vector<Contact>& contacts, Scratch& scratch) const {
  std::vector<Vec3> lift(part.vertices.size());
  std::vector<int> hints(opponents.size(), -1);
  Contact unused;
  for (int round = 0; round < k_sag_rounds; ++round) {
    std::fill(lift.begin(), lift.end(), Vec3::Zero());
    bool any = false;
    for (const Edge& e : part.edges) {
      const Contact &a = contacts[at(e[0])], &b = contacts[at(e[1])];
      if (!a.near && !b.near) continue;
      const Vec3 p = scratch.x[at(part.vertices[at(e[0])])], q = scratch.x[at(part.vertices[at(e[1])])];
      const double length = (p - q).norm();
      // A chord of a circle whose normals turn by t sags by length * t / 8.
      if (a.near && b.near && length * (a.normal - b.normal).norm() < 0.8 * settings.gap) continue;
      Vec3 middle = 0.5 * (p + q);
      const Vec3 before = middle;
      if (!push_out(part, e[0], e[1], opponents, scratch, middle, unused, hints)) continue;
      any = true;
      for (const int end : e) {
        Vec3& l = lift[at(end)];
        const Vec3 wanted = middle - before;
        if (wanted.squaredNorm() > l.squaredNorm()) l = wanted;
      }
    }
    if (!any) return;
    for (std::size_t i = 0; i < lift.size(); ++i) scratch.x[at(part.vertices[i])] += lift[i];
  }
}

int FeasibleCollider::Impl::deepest_opponent(const Yielding& part, const Vec3& point, const Scratch& scratch) const {
  int deepest = -1;
  double distance = std::numeric_limits<double>::infinity();
  for (const Opponent& opponent : part.opponents)
    for (const int other : opponent.parts) {
      const int one[1] = {other};
      if (scratch.trees[at(other)].empty()) continue;
      const double reach = std::max(surface->depth_limit(other), settings.gap);
      int hint = -1;
      const auto answer = surface->distance(point, one, part.allowed, reach, {scratch.x, scratch.trees}, hint);
      if (answer && answer->distance < distance) distance = answer->distance, deepest = other;
    }
  return deepest;
}

void FeasibleCollider::Impl::give_way(int p, Scratch& scratch) const {
  const Yielding& part = yielding[at(p)];
  const std::vector<Opponent> opponents = opponents_now(part, scratch);
  if (opponents.empty()) return;
  const std::size_t count = part.vertices.size();
  std::vector<Vec3> drawn(count), displacement(count);
  std::vector<Contact> contacts(count);
  std::vector<char> moved(count, 0);
  for (std::size_t i = 0; i < count; ++i) drawn[i] = scratch.x[at(part.vertices[i])];
  const auto project = [&] {
    parallel_for(count, k_block, [&](std::size_t begin, std::size_t end) {
      std::vector<int> hints(opponents.size(), -1);
      for (std::size_t i = begin; i < end; ++i)
        if (push_out(part, static_cast<int>(i), -1, opponents, scratch, scratch.x[at(part.vertices[i])], contacts[i], hints))
          moved[i] = 1;
    });
  };
  project();
  if (std::find(moved.begin(), moved.end(), 1) != moved.end()) {
    for (int round = 1; round < k_project_rounds; ++round) {
      for (int sweep = 0; sweep < k_smooth_sweeps; ++sweep) {
        for (std::size_t i = 0; i < count; ++i) displacement[i] = scratch.x[at(part.vertices[i])] - drawn[i];
        for (std::size_t i = 0; i < count; ++i) {
          const auto row = part.neighbours.row(static_cast<int>(i));
          if (moved[i] == 0 || row.empty()) continue;
          Vec3 mean = Vec3::Zero();
          for (const int j : row) mean += displacement[at(j)];
          scratch.x[at(part.vertices[i])] =
              drawn[i] + 0.5 * displacement[i] + (0.5 / static_cast<double>(row.size())) * mean;
        }
      }
      project();
    }
  }
  lift_edges(part, opponents, contacts, scratch);
}

FeasibleCollider::FeasibleCollider(const Surface& drawn, std::span<const Vec3> bind_pose, const FeasibleSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  CHECK(static_cast<int>(bind_pose.size()) == drawn.vertex_count() && !drawn.parts.empty());
  m.settings = settings;
  m.parts = drawn.parts;
  m.by_size.resize(m.parts.size());
  std::iota(m.by_size.begin(), m.by_size.end(), 0);
  std::stable_sort(m.by_size.begin(), m.by_size.end(),
                   [&](int a, int b) { return m.parts[at(a)].size > m.parts[at(b)].size; });
  std::vector<int> rank(m.parts.size());
  for (std::size_t i = 0; i < m.by_size.size(); ++i) rank[at(m.by_size[i])] = static_cast<int>(i);
  m.mesh = refine_mesh(bind_pose, drawn.triangles, settings.max_edge);
  m.add_refined_parts(drawn, rank);
  std::vector<Vec3> bind(at(m.mesh.vertex_count()));
  m.mesh.positions(bind_pose, bind);
  m.surface = std::make_unique<PartSurface>(bind, m.mesh.triangles, m.part_of_vertex, static_cast<int>(m.parts.size()));
  m.find_opponents(rank);
  m.find_touching(bind);
}

FeasibleCollider::~FeasibleCollider() = default;

int FeasibleCollider::vertex_count() const { return impl_->mesh.vertex_count(); }
std::span<const Triangle> FeasibleCollider::triangles() const { return impl_->mesh.triangles; }
std::span<const int> FeasibleCollider::part_of_vertex() const { return impl_->part_of_vertex; }

bool FeasibleCollider::kept_apart(int part_a, int part_b) const {
  if (part_a == part_b || impl_->jointed(part_a, part_b)) return false;
  return impl_->yielding[at(part_a)].touching_part(part_b) == nullptr &&
         impl_->yielding[at(part_b)].touching_part(part_a) == nullptr;
}

void FeasibleCollider::refine(std::span<const Vec3> drawn, std::span<Vec3> refined) const {
  impl_->mesh.positions(drawn, refined);
}

CarveReport FeasibleCollider::evaluate(std::span<const Vec3> drawn, std::span<Vec3> positions) const {
  refine(drawn, positions);
  CarveReport report;
  if (!impl_->settings.carve || impl_->parts.size() < 2) return report;
  std::vector<Vec3> before(positions.begin(), positions.end());
  Impl::Scratch scratch{positions, std::vector<TriangleTree>(impl_->parts.size())};
  for (const int part : impl_->by_size) impl_->give_way(part, scratch);
  const auto representative = impl_->surface->representative();
  for (const int v : impl_->copies) {
    const std::size_t r = at(representative[at(v)]);
    positions[at(v)] += positions[r] - before[r];
  }
  std::size_t farthest = 0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    const double move = (positions[v] - before[v]).norm();
    if (move > 0) ++report.moved_vertices;
    if (move > report.largest_move) report.largest_move = move, farthest = v;
  }
  if (report.moved_vertices > 0) {
    report.part_a = impl_->part_of_vertex[farthest];
    report.part_b = impl_->deepest_opponent(impl_->yielding[at(report.part_a)], before[farthest], scratch);
  }
  return report;
}

}  // namespace ft

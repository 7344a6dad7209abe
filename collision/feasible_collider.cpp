// See feasible_collider.h. The parts are walked from the largest to the smallest, each against all larger ones, which are final
// by then. One part: find its vertices near or inside larger parts, push them out, smooth the displacement so that no triangle
// tears, push out again, then lift edges that sag into a curved larger part. Nothing is remembered between calls.
#include "collision/feasible_collider.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "collision/carve_plan.h"
#include "collision/mesh_refine.h"
#include "collision/nearby_leaves.h"
#include "collision/part_distance.h"

namespace ft {
namespace {

constexpr int k_push_rounds = 3;        ///< rounds of pushing out, so that a vertex between two parts settles
constexpr int k_smooth_sweeps = 8;      ///< Laplacian sweeps of the displacement between rounds
constexpr double k_smooth_move = 20e-3; ///< move from which on a vertex is smoothed fully [m]
constexpr int k_groove_rounds = 6;      ///< rounds for one point between several parts
constexpr double k_facing = -0.9;       ///< cosine of two parts' normals below which they make a slot, not a groove
constexpr int k_membrane_sweeps = 40;   ///< sweeps that draw a part over a slot
constexpr double k_content = 1e-9;      ///< missing distance that is not worth a push [m]
constexpr int k_sag_rounds = 3;         ///< rounds of lifting edges
constexpr double k_sag_share = 0.85;    ///< share of the gap that edges' middles must keep [1]
constexpr std::size_t k_block = 16 * k_cluster;  ///< vertices per parallel block

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Where a vertex is with respect to one opponent.
enum class Side : char { k_away, k_near, k_unknown, k_inside };

}  // namespace

struct FeasibleCollider::Impl {
  FeasibleSettings settings;
  RefinedMesh mesh;
  std::vector<int> part_of_vertex;
  std::unique_ptr<PartSurface> surface;
  CarvePlan plan;
  double near = 0;  ///< distances up to this are always found [m]; above half an edge, so that no edge passes a surface unseen

  /// Positions, boxes and trees of one evaluation.
  struct Scratch {
    std::span<Vec3> x;
    std::vector<TreeBox> boxes;
    std::vector<TriangleTree> trees;
  };
  struct Contact {
    Vec3 normal = Vec3::Zero();
    double distance = std::numeric_limits<double>::infinity();  ///< to the nearest opponent [m]
    bool squeezed = false;            ///< in a slot between two opponents that is too narrow for both distances
  };
  /// One part's work in one evaluation.
  struct Carving {
    const Yielding& part;
    std::vector<Opponent> opponents;  ///< those near enough now
    std::vector<Contact> contacts;    ///< per local vertex
    std::vector<char> inside;         ///< per local vertex: deep inside an opponent
    std::vector<char> is_active;      ///< per local vertex
    std::vector<int> active;          ///< local vertices that may have to move, ascending
    std::vector<char> moved;
  };

  TreeBox box_of(int part, std::span<const Vec3> x) const;
  std::vector<Opponent> opponents_now(const Yielding& part, const TreeBox& own, Scratch& scratch) const;
  void find_active(Carving& carving, const Scratch& scratch) const;
  void look_around(Carving& carving, const Opponent& opponent, const Scratch& scratch, std::size_t begin, std::size_t end,
                   std::vector<Side>& side) const;
  void resolve_unknown(const Carving& carving, const Opponent& opponent, const Scratch& scratch, std::vector<Side>& side) const;
  template <class Keep, class Reach>
  bool push(const Carving& carving, const Scratch& scratch, Vec3& point, std::span<int> hints, Keep&& keep, Reach&& reach,
            Contact* contact) const;
  bool push_out(const Carving& carving, int local, const Scratch& scratch, Vec3& point, Contact& contact,
                std::span<int> hints) const;
  bool lift_middle(const Carving& carving, const Edge& edge, const Scratch& scratch, Vec3& middle, std::span<int> hints) const;
  void push_out_all(Carving& carving, Scratch& scratch) const;
  void span_slots(Carving& carving, Scratch& scratch) const;
  void smooth(const Carving& carving, std::span<const Vec3> drawn, Scratch& scratch) const;
  void lift_edges(const Carving& carving, Scratch& scratch) const;
  void give_way(int part, Scratch& scratch) const;
  int deepest_opponent(const Yielding& part, const Vec3& point, const Scratch& scratch) const;
};

TreeBox FeasibleCollider::Impl::box_of(int part, std::span<const Vec3> x) const {
  Box box;
  for (const int v : plan.yielding[at(part)].vertices) box.include(x[at(v)]);
  return TreeBox::around(box.lo, box.hi);
}

/// Opponents whose boxes, grown by the gap, meet the part's now; their trees are brought up to date.
std::vector<Opponent> FeasibleCollider::Impl::opponents_now(const Yielding& part, const TreeBox& own,
                                                            Scratch& scratch) const {
  std::vector<Opponent> out;
  for (const Opponent& opponent : part.opponents) {
    Opponent now{opponent.shell, {}};
    for (const int other : opponent.parts) {
      if (!own.overlaps(scratch.boxes[at(other)], 2 * settings.max_edge + settings.gap)) continue;
      TriangleTree& tree = scratch.trees[at(other)];
      if (tree.empty()) {
        tree = surface->tree(other);
        tree.refit(scratch.x, surface->triangles());
      }
      if (own.overlaps(tree.box(), settings.gap)) now.parts.push_back(other);
    }
    if (!now.parts.empty()) out.push_back(std::move(now));
  }
  return out;
}

/// Far vertices of unknown side: those connected to one that is away are away too, for an edge cannot pass the opponent's surface
/// without an end near it. Of the others a closed opponent is asked once per connected piece, an open one for every vertex.
void FeasibleCollider::Impl::resolve_unknown(const Carving& carving, const Opponent& opponent, const Scratch& scratch,
                                             std::vector<Side>& side) const {
  const Yielding& part = carving.part;
  std::vector<int> queue, piece;
  const auto grow = [&](Side as) {
    while (!queue.empty()) {
      const int v = queue.back();
      queue.pop_back();
      piece.push_back(v);
      for (const int w : part.neighbours.row(v))
        if (side[at(w)] == Side::k_unknown) side[at(w)] = as, queue.push_back(w);
    }
  };
  for (int v = 0; v < static_cast<int>(side.size()); ++v)
    if (side[at(v)] == Side::k_away) queue.push_back(v);
  grow(Side::k_away);
  const bool closed = opponent.parts.size() == 1 && surface->closed(opponent.parts[0]);
  double reach = 0;
  for (const int other : opponent.parts) reach = std::max(reach, surface->depth_limit(other));
  for (int v = 0; v < static_cast<int>(side.size()); ++v) {
    if (side[at(v)] != Side::k_unknown) continue;
    int hint = -1;
    const auto answer = surface->distance(scratch.x[at(part.vertices[at(v)])], opponent.parts, part.allowed, reach,
                                          {scratch.x, scratch.trees}, hint);
    side[at(v)] = answer && answer->distance < 0 ? Side::k_inside : Side::k_away;
    if (!closed) continue;
    const Side as = side[at(v)];
    queue.assign(1, v);
    grow(as);
  }
}

/// Sides and contacts of one cluster of vertices [begin, end) with respect to one opponent.
void FeasibleCollider::Impl::look_around(Carving& carving, const Opponent& opponent, const Scratch& scratch, std::size_t begin,
                                         std::size_t end, std::vector<Side>& side) const {
  const Yielding& part = carving.part;
  Box box;
  for (std::size_t i = begin; i < end; ++i) box.include(scratch.x[at(part.vertices[i])]);
  box.inflate(near);
  const TreeBox cluster = TreeBox::around(box.lo, box.hi);
  NearbyLeaves leaves(0.5 * (box.lo + box.hi));
  bool in_box = false;
  for (const int other : opponent.parts) {
    const TriangleTree& tree = scratch.trees[at(other)];
    if (!tree.box().overlaps(cluster)) continue;
    in_box = true;
    tree.for_each_leaf_near(cluster, [&](const TriangleTree::Node& leaf) { leaves.add(tree, leaf); });
  }
  for (std::size_t i = begin; i < end; ++i) {
    side[i] = Side::k_away;
    if (!in_box) continue;
    const Vec3& p = scratch.x[at(part.vertices[i])];
    bool held = false;
    for (const int other : opponent.parts) {
      if (scratch.trees[at(other)].box().squared_distance(p) > near * near) continue;
      // Free vertices stand where the surfaces overlap for good: sides must not spread over them.
      if (side[i] == Side::k_away) side[i] = Side::k_near;
      held = held || plan.keep(part, static_cast<int>(i), other) != k_free;
    }
    if (!held) continue;
    side[i] = Side::k_unknown;
    const TriangleTree::Hit hit = leaves.closest(p, near, scratch.x, surface->triangles());
    if (hit.triangle < 0) continue;
    side[i] = Side::k_near;
    const auto answer = surface->judge(p, hit, part.allowed, scratch.x);
    if (!answer) continue;
    const double keep = plan.keep(part, static_cast<int>(i), answer->part);
    if (keep == settings.gap && answer->distance < carving.contacts[i].distance)
      carving.contacts[i] = {answer->normal, answer->distance};
    if (answer->distance < keep) carving.is_active[i] = 1;
  }
}

void FeasibleCollider::Impl::find_active(Carving& carving, const Scratch& scratch) const {
  const std::size_t count = carving.part.vertices.size();
  std::vector<Side> side(count);
  for (const Opponent& opponent : carving.opponents) {
    parallel_for(count, k_block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; i += k_cluster)
        look_around(carving, opponent, scratch, i, std::min(end, i + k_cluster), side);
    });
    if (std::find(side.begin(), side.end(), Side::k_unknown) == side.end()) continue;
    resolve_unknown(carving, opponent, scratch, side);
    for (std::size_t i = 0; i < count; ++i)
      if (side[i] == Side::k_inside) carving.inside[i] = carving.is_active[i] = 1;
  }
  for (std::size_t i = 0; i < count; ++i)
    if (carving.is_active[i] != 0) carving.active.push_back(static_cast<int>(i));
}

/// Moves the point until it keeps its distance from every opponent, or for some rounds; true when it moved. keep(part) is the
/// distance, reach(part, squared distance from its box) how far to look. Between two opponents it takes the shortest way to
/// where both are content, as if they were planes: pushing by turns creeps in a groove.
template <class Keep, class Reach>
bool FeasibleCollider::Impl::push(const Carving& carving, const Scratch& scratch, Vec3& point, std::span<int> hints, Keep&& keep,
                                  Reach&& reach, Contact* contact) const {
  bool moved = false;
  for (int round = 0; round < k_groove_rounds; ++round) {
    std::array<Contact, 2> worst{};  // distance: how much is missing
    worst[0].distance = worst[1].distance = 0;
    int looked_at = 0;
    for (std::size_t k = 0; k < carving.opponents.size(); ++k) {
      const Opponent& opponent = carving.opponents[k];
      double how_far = 0;
      for (const int other : opponent.parts)
        how_far = std::max(how_far, reach(other, scratch.trees[at(other)].box().squared_distance(point)));
      if (how_far == 0) continue;
      ++looked_at;
      const auto answer =
          surface->distance(point, opponent.parts, carving.part.allowed, how_far, {scratch.x, scratch.trees}, hints[k]);
      if (!answer) continue;
      const double wanted = keep(answer->part);
      if (contact != nullptr && round == 0 && wanted == settings.gap && answer->distance < contact->distance)
        *contact = {answer->normal, std::max(answer->distance, wanted)};
      const double missing = wanted - answer->distance;
      if (missing <= worst[1].distance) continue;
      worst[1] = {answer->normal, missing};
      if (worst[1].distance > worst[0].distance) std::swap(worst[0], worst[1]);
    }
    if (worst[0].distance <= k_content) return moved;
    moved = true;
    const double cosine = worst[0].normal.dot(worst[1].normal), u = worst[0].distance, v = worst[1].distance;
    if (v <= cosine * u) {  // one push does for both
      point += u * worst[0].normal;
    } else if (cosine < k_facing) {  // a slot: its middle
      point += 0.5 * (u - v) * worst[0].normal;
      if (contact != nullptr) contact->squeezed = true;
    } else {
      const double sine2 = 1 - cosine * cosine;
      point += ((u - cosine * v) * worst[0].normal + (v - cosine * u) * worst[1].normal) / sine2;
    }
    if (looked_at < 2) return moved;
  }
  return moved;
}

bool FeasibleCollider::Impl::push_out(const Carving& carving, int local, const Scratch& scratch, Vec3& point,
                                      Contact& contact, std::span<int> hints) const {
  const bool deep = carving.inside[at(local)] != 0 || carving.moved[at(local)] != 0;
  contact = {};
  return push(
      carving, scratch, point, hints, [&](int other) { return plan.keep(carving.part, local, other); },
      [&](int other, double d2) {
        if (d2 > near * near || plan.keep(carving.part, local, other) == k_free) return 0.0;
        return d2 == 0 && deep ? std::max(near, surface->depth_limit(other)) : near;
      },
      &contact);
}

void FeasibleCollider::Impl::push_out_all(Carving& carving, Scratch& scratch) const {
  parallel_for(carving.active.size(), k_block, [&](std::size_t begin, std::size_t end) {
    std::vector<int> hints(carving.opponents.size(), -1);
    for (std::size_t i = begin; i < end; ++i) {
      const int v = carving.active[i];
      if (push_out(carving, v, scratch, scratch.x[at(carving.part.vertices[at(v)])], carving.contacts[at(v)], hints))
        carving.moved[at(v)] = 1;
    }
  });
}

void FeasibleCollider::Impl::smooth(const Carving& carving, std::span<const Vec3> drawn, Scratch& scratch) const {
  const Yielding& part = carving.part;
  std::vector<Vec3> next(carving.active.size());
  // Vertices that have hardly moved are hardly smoothed, so that a vertex that starts to move does not jump.
  std::vector<double> share(next.size());
  for (std::size_t i = 0; i < share.size(); ++i) {
    const int v = carving.active[i];
    share[i] = 0.5 * std::min(1.0, (scratch.x[at(part.vertices[at(v)])] - drawn[at(v)]).norm() / k_smooth_move);
  }
  for (int sweep = 0; sweep < k_smooth_sweeps; ++sweep) {
    const auto displacement = [&](int v) { return (scratch.x[at(part.vertices[at(v)])] - drawn[at(v)]).eval(); };
    for (std::size_t i = 0; i < next.size(); ++i) {
      const int v = carving.active[i];
      const auto row = part.neighbours.row(v);
      Vec3 mean = Vec3::Zero();
      for (const int w : row) mean += displacement(w);
      next[i] = row.empty() || carving.moved[at(v)] == 0
                    ? displacement(v)
                    : ((1 - share[i]) * displacement(v) + (share[i] / static_cast<double>(row.size())) * mean).eval();
    }
    for (std::size_t i = 0; i < next.size(); ++i)
      scratch.x[at(part.vertices[at(carving.active[i])])] = drawn[at(carving.active[i])] + next[i];
  }
}

/// Vertices in slots are drawn out by their neighbours until the part spans the slot like a membrane: there is no room in it for
/// the part, and an edge from its depth to the outside would cut its lip.
void FeasibleCollider::Impl::span_slots(Carving& carving, Scratch& scratch) const {
  const Yielding& part = carving.part;
  std::vector<int> squeezed;
  for (const int v : carving.active)
    if (carving.contacts[at(v)].squeezed && !part.neighbours.row(v).empty()) squeezed.push_back(v);
  std::vector<Vec3> next(squeezed.size());
  for (int sweep = 0; !squeezed.empty() && sweep < k_membrane_sweeps; ++sweep) {
    for (std::size_t i = 0; i < squeezed.size(); ++i) {
      const auto row = part.neighbours.row(squeezed[i]);
      next[i].setZero();
      for (const int w : row) next[i] += scratch.x[at(part.vertices[at(w)])] / static_cast<double>(row.size());
    }
    for (std::size_t i = 0; i < squeezed.size(); ++i) scratch.x[at(part.vertices[at(squeezed[i])])] = next[i];
  }
  for (const int v : squeezed) carving.contacts[at(v)] = {Vec3::Zero(), 0, true};  // lift_edges() must look for itself
}

/// The middle of an edge, moved to where it keeps its share of the gap; only where both ends have to keep the whole gap.
bool FeasibleCollider::Impl::lift_middle(const Carving& carving, const Edge& edge, const Scratch& scratch, Vec3& middle,
                                         std::span<int> hints) const {
  const auto held = [&](int other) {
    return plan.keep(carving.part, edge[0], other) == settings.gap && plan.keep(carving.part, edge[1], other) == settings.gap;
  };
  return push(
      carving, scratch, middle, hints, [&](int other) { return held(other) ? k_sag_share * settings.gap : k_free; },
      [&](int, double d2) { return d2 <= settings.gap * settings.gap ? near : 0.0; }, nullptr);
}

/// Edges whose ends keep the gap may still cut a larger part's curve: their middles are lifted, and both ends with them.
void FeasibleCollider::Impl::lift_edges(const Carving& carving, Scratch& scratch) const {
  const Yielding& part = carving.part;
  std::vector<Vec3> lift(part.vertices.size());
  std::vector<int> hints(carving.opponents.size(), -1);
  for (int round = 0; round < k_sag_rounds; ++round) {
    std::fill(lift.begin(), lift.end(), Vec3::Zero());
    bool any = false;
    for (const Edge& e : part.edges) {
      const Contact &a = carving.contacts[at(e[0])], &b = carving.contacts[at(e[1])];
      if (std::min(a.distance, b.distance) > near) continue;
      const Vec3 p = scratch.x[at(part.vertices[at(e[0])])], q = scratch.x[at(part.vertices[at(e[1])])];
      const double length = (p - q).norm();
      const double farther = std::max(a.distance, b.distance);
      if (farther - 0.5 * length > settings.gap) continue;
      // A chord of a circle whose normals turn by t sags by length * t / 8.
      if (farther <= near && length * (a.normal - b.normal).norm() < 8 * (1 - k_sag_share) * settings.gap) continue;
      Vec3 middle = 0.5 * (p + q);
      const Vec3 before = middle;
      if (!lift_middle(carving, e, scratch, middle, hints)) continue;
      any = true;
      for (const int end : e) {
        Vec3& l = lift[at(end)];
        if ((middle - before).squaredNorm() > l.squaredNorm()) l = middle - before;
      }
    }
    if (!any) return;
    for (std::size_t i = 0; i < lift.size(); ++i) scratch.x[at(part.vertices[i])] += lift[i];
  }
}

void FeasibleCollider::Impl::give_way(int p, Scratch& scratch) const {
  const Yielding& part = plan.yielding[at(p)];
  const std::size_t count = part.vertices.size();
  Carving carving{part, opponents_now(part, scratch.boxes[at(p)], scratch), {}, {}, {}, {}, {}};
  if (count == 0 || carving.opponents.empty()) return;
  carving.contacts.resize(count);
  carving.inside.assign(count, 0);
  carving.is_active.assign(count, 0);
  carving.moved.assign(count, 0);
  find_active(carving, scratch);
  if (!carving.active.empty()) {
    std::vector<Vec3> drawn(count);
    for (std::size_t i = 0; i < count; ++i) drawn[i] = scratch.x[at(part.vertices[i])];
    push_out_all(carving, scratch);
    for (int round = 1; round < k_push_rounds; ++round) {
      smooth(carving, drawn, scratch);
      push_out_all(carving, scratch);
    }
  }
  span_slots(carving, scratch);
  lift_edges(carving, scratch);
  scratch.boxes[at(p)] = box_of(p, scratch.x);
}

int FeasibleCollider::Impl::deepest_opponent(const Yielding& part, const Vec3& point, const Scratch& scratch) const {
  int deepest = -1;
  double distance = std::numeric_limits<double>::infinity();
  for (const Opponent& opponent : part.opponents)
    for (const int other : opponent.parts) {
      if (scratch.trees[at(other)].empty()) continue;
      const int one[1] = {other};
      const double reach = std::max(surface->depth_limit(other), settings.gap);
      int hint = -1;
      const auto answer = surface->distance(point, one, part.allowed, reach, {scratch.x, scratch.trees}, hint);
      if (answer && answer->distance < distance) distance = answer->distance, deepest = other;
    }
  return deepest;
}

FeasibleCollider::FeasibleCollider(const Surface& drawn, std::span<const Vec3> bind_pose, const FeasibleSettings& settings)
    : impl_(std::make_unique<Impl>()) {
  Impl& m = *impl_;
  CHECK(static_cast<int>(bind_pose.size()) == drawn.vertex_count() && !drawn.parts.empty());
  m.settings = settings;
  m.near = std::max(1.5 * settings.gap, 0.55 * settings.max_edge);
  m.mesh = refine_mesh(bind_pose, drawn.triangles, settings.max_edge);
  std::vector<int> rank(drawn.parts.size());
  const std::vector<int> by_size = parts_by_size(drawn.parts);
  for (std::size_t i = 0; i < by_size.size(); ++i) rank[at(by_size[i])] = static_cast<int>(i);
  m.part_of_vertex = drawn.part_of_vertex;
  for (const RefinedMesh::Blend& blend : m.mesh.blends) {
    const int p = m.part_of_vertex[at(blend.a)], q = m.part_of_vertex[at(blend.b)];
    m.part_of_vertex.push_back(rank[at(p)] <= rank[at(q)] ? p : q);
  }
  if (!settings.carve || drawn.parts.size() < 2) return;
  std::vector<Vec3> bind(at(m.mesh.vertex_count()));
  m.mesh.positions(bind_pose, bind);
  m.surface = std::make_unique<PartSurface>(bind, m.mesh.triangles, m.part_of_vertex, static_cast<int>(drawn.parts.size()));
  m.plan = make_carve_plan(*m.surface, drawn.parts, m.part_of_vertex, bind, settings.gap);
}

FeasibleCollider::~FeasibleCollider() = default;

int FeasibleCollider::vertex_count() const { return impl_->mesh.vertex_count(); }
std::span<const Triangle> FeasibleCollider::triangles() const { return impl_->mesh.triangles; }
std::span<const int> FeasibleCollider::part_of_vertex() const { return impl_->part_of_vertex; }

bool FeasibleCollider::kept_apart(int part_a, int part_b) const {
  if (impl_->surface == nullptr || part_a == part_b || impl_->plan.jointed(part_a, part_b)) return false;
  const auto& yielding = impl_->plan.yielding;
  return yielding[at(part_a)].touching_part(part_b) == nullptr && yielding[at(part_b)].touching_part(part_a) == nullptr;
}

void FeasibleCollider::refine(std::span<const Vec3> drawn, std::span<Vec3> refined) const {
  impl_->mesh.positions(drawn, refined);
}

CarveReport FeasibleCollider::evaluate(std::span<const Vec3> drawn, std::span<Vec3> positions) const {
  refine(drawn, positions);
  CarveReport report;
  if (impl_->surface == nullptr) return report;
  const std::vector<Vec3> before(positions.begin(), positions.end());
  const int part_count = impl_->surface->part_count();
  Impl::Scratch scratch{positions, std::vector<TreeBox>(at(part_count)), std::vector<TriangleTree>(at(part_count))};
  for (int part = 0; part < part_count; ++part) scratch.boxes[at(part)] = impl_->box_of(part, positions);
  for (const int part : impl_->plan.by_size) impl_->give_way(part, scratch);
  const auto representative = impl_->surface->representative();
  for (const int v : impl_->plan.copies) {
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
    report.part_b = impl_->deepest_opponent(impl_->plan.yielding[at(report.part_a)], before[farthest], scratch);
  }
  return report;
}

}  // namespace ft

#include "collision/body/carver.h"

#include <algorithm>
#include <cmath>

#include "baker/core/parallel.h"

namespace ft::inline collision {
namespace {

constexpr int k_push_rounds = 3;         ///< rounds of pushing out, so that a vertex between two parts settles
constexpr int k_smooth_sweeps = 8;       ///< Laplacian sweeps of the displacement between rounds
constexpr double k_smooth_move = 20e-3;  ///< move from which on a vertex is smoothed fully [m]
constexpr int k_groove_rounds = 6;       ///< rounds for one point between several parts
constexpr double k_facing = -0.9;        ///< cosine of two parts' normals below which they make a slot, not a groove
constexpr int k_membrane_sweeps = 40;    ///< sweeps that draw a part over a slot
constexpr double k_content = 1e-9;       ///< missing distance that is not worth a push [m]
constexpr int k_sag_rounds = 3;          ///< rounds of lifting edges
constexpr double k_sag_share = 0.85;     ///< share of the gap that edges' middles must keep [1]

}  // namespace

/// Moves the point until it keeps its distance from every opponent, or for some rounds; true when it moved. keep(part)
/// is the distance, reach(part, squared distance from its box) how far to look. Between two opponents it takes the
/// shortest way to where both are content, as if they were planes: pushing by turns creeps in a groove.
template <class Keep, class Reach>
bool Carver::push(const Carving& carving, const Scratch& scratch, Vec3& point, std::span<int> hints, Keep&& keep,
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

bool Carver::push_out(const Carving& carving, int local, const Scratch& scratch, Vec3& point, Contact& contact,
                      std::span<int> hints) const {
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

/// again: those that have moved; the others stand where they were found to be well.
void Carver::push_out_all(Carving& carving, bool again, Scratch& scratch) const {
  parallel_for(carving.active.size(), k_carve_block, [&](std::size_t begin, std::size_t end) {
    std::vector<int> hints(carving.opponents.size(), -1);
    for (std::size_t i = begin; i < end; ++i) {
      const int v = carving.active[i];
      if (again && carving.moved[at(v)] == 0) continue;
      if (push_out(carving, v, scratch, scratch.x[at(carving.part.vertices[at(v)])], carving.contacts[at(v)], hints))
        carving.moved[at(v)] = 1;
    }
  });
}

void Carver::smooth(const Carving& carving, std::span<const Vec3> drawn, Scratch& scratch) const {
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

/// Vertices in slots are drawn out by their neighbours until the part spans the slot like a membrane: there is no room
/// in it for the part, and an edge from its depth to the outside would cut its lip.
void Carver::span_slots(Carving& carving, Scratch& scratch) const {
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

/// The middle of an edge, moved to where it keeps its share of the gap; only where both ends have to keep the whole
/// gap.
bool Carver::lift_middle(const Carving& carving, const Edge& edge, const Scratch& scratch, Vec3& middle,
                         std::span<int> hints) const {
  const auto held = [&](int other) {
    return plan.keep(carving.part, edge[0], other) == settings.gap &&
           plan.keep(carving.part, edge[1], other) == settings.gap;
  };
  return push(
      carving, scratch, middle, hints, [&](int other) { return held(other) ? k_sag_share * settings.gap : k_free; },
      [&](int, double d2) { return d2 <= settings.gap * settings.gap ? near : 0.0; }, nullptr);
}

/// Edges whose ends keep the gap may still cut a larger part's curve: their middles are lifted, and both ends with
/// them.
void Carver::lift_edges(const Carving& carving, Scratch& scratch) const {
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

void Carver::give_way(int p, Scratch& scratch) const {
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
    push_out_all(carving, false, scratch);
    for (int round = 1; round < k_push_rounds; ++round) {
      smooth(carving, drawn, scratch);
      push_out_all(carving, true, scratch);
    }
  }
  span_slots(carving, scratch);
  lift_edges(carving, scratch);
  scratch.boxes[at(p)] = box_of(p, scratch.x);
}

int Carver::deepest_opponent(const Yielding& part, const Vec3& point, const Scratch& scratch) const {
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

}  // namespace ft::inline collision

// See droplet_bodies.h. Triangles' corners go in straight lines in a step, as droplets do, so that a droplet is in a
// triangle's plane at a root of a cubic. Who may meet whom: a grid says where driven triangles come in the frame at
// all; where it says so, a tree over boxes that hold the ways of triangles in a window of the frame, a few centimetres
// long. Trees of what floats are in its own axes, in which ways of droplets are looked for.
#include "solvers/water/droplet_bodies.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "baker/core/check.h"
#include "baker/core/parallel.h"
#include "solvers/water/droplet_crossing.h"

namespace ft::inline solvers {
namespace {

constexpr std::size_t k_block = 256;
constexpr int k_grid = 64;             ///< cells along the longest side
constexpr double k_window_way = 0.05;  ///< a driven vertex goes no farther in a window of several steps [m]
constexpr int k_most_meetings = 8;     ///< of a droplet in a step; then it goes with what it met last
constexpr int k_sweeps = 8;
constexpr std::size_t k_most_contacts = 3;
/// Of a droplet's speed: what it may still go against a contact [1].
constexpr double k_still = 1e-9;

struct Contact {
  Vec3 normal, velocity;
  double against(const Vec3& v) const { return (v - velocity).dot(normal); }
};

Box path_box(const Vec3& from, const Vec3& to) {
  Box out;
  out.include(from);
  out.include(to);
  out.inflate(2 * DropletBodies::k_skin);
  return out;
}

/// Calls visit(cell) for the cells of a grid that a box overlaps, until it says true; whether it did.
template <class Visit>
bool for_cells(const Box& grid, double cell, const std::array<int, 3>& cells, const Box& box, Visit&& visit) {
  std::array<int, 3> lo, hi;
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = static_cast<int>(k);
    const auto index = [&](double x) {
      return static_cast<int>(std::clamp((x - grid.lo[axis]) / cell, 0.0, cells[k] - 1.0));
    };
    lo[k] = index(box.lo[axis]), hi[k] = index(box.hi[axis]);
  }
  for (int z = lo[2]; z <= hi[2]; ++z)
    for (int y = lo[1]; y <= hi[1]; ++y)
      for (int x = lo[0]; x <= hi[0]; ++x)
        if (visit(at(x) + at(cells[0]) * (at(y) + at(cells[1]) * at(z)))) return true;
  return false;
}

/// Velocity without what goes against any of the contacts; the last one's where they leave no way.
Vec3 held_off(Vec3 v, std::span<const Contact> contacts) {
  const double speed = v.norm();
  for (int sweep = 0; sweep < k_sweeps; ++sweep) {
    bool free = true;
    for (const Contact& c : contacts) {
      const double against = c.against(v);
      if (against >= -k_still * speed) continue;
      v -= against * c.normal;
      free = false;
    }
    if (free) return v;
  }
  return contacts.back().velocity;
}

}  // namespace

struct DropletBodies::Hit : DropletCrossing {
  const Body* body = nullptr;
  int triangle = -1;
};

DropletBodies::DropletBodies(std::span<const DrivenBody> driven, std::vector<const FloatingBody*> floats,
                             const Vec3& origin, double friction)
    : driven_(driven.begin(), driven.end()), origin_(origin), friction_(friction) {
  bodies_.resize(driven_.size() + floats.size());
  for (std::size_t b = 0; b < driven_.size(); ++b) bodies_[b].driven = &driven_[b];
  for (std::size_t b = 0; b < floats.size(); ++b) {
    Body& body = bodies_[driven_.size() + b];
    body.floating = floats[b];
    body.first = floats[b]->positions;
    body.triangles = floats[b]->triangles;
    for (const Vec3& p : body.first) body.reach = std::max(body.reach, p.norm());
  }
}

void DropletBodies::set_step(double share0, double share1, std::span<const RigidPose> from,
                             std::span<const RigidPose> to) {
  CHECK(from.size() == to.size() && driven_.size() + from.size() == bodies_.size());
  share0_ = share0, share1_ = share1;
  for (std::size_t n = 0; n < from.size(); ++n) {
    Body& body = bodies_[driven_.size() + n];
    body.pose0 = from[n], body.pose1 = to[n];
    // Between its ends a turn is off a straight line by its sagitta.
    const double turn = body.pose0.rotation.angularDistance(body.pose1.rotation);
    body.slack = 4 * body.reach * (1 - std::cos(0.5 * turn));
  }
}

void DropletBodies::stop(std::span<Droplet> droplets, std::span<const Vec3> starts, double dt,
                         std::span<const double> since) {
  if (bodies_.empty() || droplets.empty()) return;
  CHECK(droplets.size() == starts.size() && (since.empty() || since.size() == starts.size()));
  Box paths;
  double longest = 0;
  for (std::size_t n = 0; n < droplets.size(); ++n) {
    paths.include(starts[n]);
    paths.include(droplets[n].place);
    longest = std::max(longest, (droplets[n].place - starts[n]).squaredNorm());
  }
  cover(paths, std::sqrt(longest));
  std::vector<char> near(droplets.size());
  parallel_for(droplets.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) near[n] = near_any(path_box(starts[n], droplets[n].place)) ? 1 : 0;
  });
  if (std::find(near.begin(), near.end(), 1) == near.end()) return;
  set_window();
  parallel_for(droplets.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      if (near[n]) meet(droplets[n], starts[n], since.empty() ? 0 : since[n], dt);
  });
}

void DropletBodies::cover(const Box& paths, double longest) {
  if (driven_.empty()) return;
  if (covered_.empty())
    for (const DrivenBody& d : driven_)
      for (std::size_t v = 0; v < d.from.size(); ++v) way_ = std::max(way_, (d.to[v] - d.from[v]).norm());
  const double span = share1_ - share0_;
  // A droplet goes no farther than its own way and twice that of what it meets.
  Box near = paths;
  near.inflate(longest + 2 * way_ * span + 2 * DropletBodies::k_skin);
  if (!covered_.empty() && (covered_.lo.array() <= near.lo.array()).all() &&
      (near.hi.array() <= covered_.hi.array()).all())
    return;
  // So wide that the frame's other steps mostly find what they need.
  covered_.include(near);
  covered_.inflate(span > 0 ? (longest + 2 * way_ * span) / span : 0);
  window1_ = window0_ - 1;
  seen_ = {};
  for (std::size_t b = 0; b < driven_.size(); ++b) keep_near(bodies_[b]);
  seen_.lo = seen_.lo.cwiseMax(covered_.lo), seen_.hi = seen_.hi.cwiseMin(covered_.hi);
  driven_in_.clear();
  if (seen_.empty()) return;
  seen_.inflate(2 * DropletBodies::k_skin);
  cell_ = seen_.size().maxCoeff() / k_grid;
  for (std::size_t k = 0; k < 3; ++k) cells_[k] = static_cast<int>(seen_.size()[static_cast<int>(k)] / cell_) + 1;
  driven_in_.assign(at(cells_[0]) * at(cells_[1]) * at(cells_[2]), 0);
  for (std::size_t b = 0; b < driven_.size(); ++b)
    for (const Triangle& t : bodies_[b].triangles) {
      Box box;
      for (const int v : t) box.include(bodies_[b].first[at(v)]), box.include(bodies_[b].last[at(v)]);
      for_cells(seen_, cell_, cells_, box, [&](std::size_t c) {
        driven_in_[c] = 1;
        return false;
      });
    }
}

void DropletBodies::keep_near(Body& body) {
  const DrivenBody& d = *body.driven;
  body.first.clear(), body.last.clear(), body.triangles.clear();
  body.tree = {};
  std::vector<int> number(d.from.size(), -1);
  for (const Triangle& t : d.triangles) {
    Box box;
    for (const int v : t) box.include(d.from[at(v)] - origin_), box.include(d.to[at(v)] - origin_);
    if (!box.overlaps(covered_)) continue;
    seen_.include(box);
    Triangle kept;
    for (std::size_t k = 0; k < 3; ++k) {
      int& n = number[at(t[k])];
      if (n < 0) {
        n = static_cast<int>(body.first.size());
        body.first.push_back(d.from[at(t[k])] - origin_);
        body.last.push_back(d.to[at(t[k])] - origin_);
      }
      kept[k] = n;
    }
    body.triangles.push_back(kept);
  }
}

void DropletBodies::set_window() {
  for (std::size_t b = driven_.size(); b < bodies_.size(); ++b)
    if (bodies_[b].tree.empty()) bodies_[b].tree = TriangleTree(bodies_[b].first, bodies_[b].triangles);
  if (window0_ <= share0_ && share1_ <= window1_) return;
  window0_ = share0_;
  window1_ = way_ > 0 ? std::max(share1_, share0_ + k_window_way / way_) : 1;
  for (std::size_t b = 0; b < driven_.size(); ++b) {
    Body& body = bodies_[b];
    if (body.triangles.empty()) continue;
    body.corners.resize(2 * body.triangles.size());
    for (std::size_t n = 0; n < body.triangles.size(); ++n) {
      Box box;
      for (const int v : body.triangles[n]) {
        const Vec3 &first = body.first[at(v)], way = body.last[at(v)] - first;
        box.include(first + window0_ * way);
        box.include(first + window1_ * way);
      }
      body.corners[2 * n] = box.lo, body.corners[2 * n + 1] = box.hi;
    }
    if (!body.tree.empty()) {
      body.tree.refit(body.corners, body.boxes);
      continue;
    }
    body.boxes.clear();
    for (int n = 0; n < static_cast<int>(body.triangles.size()); ++n)
      body.boxes.push_back({2 * n, 2 * n + 1, 2 * n + 1});
    body.tree = TriangleTree(body.corners, body.boxes);
  }
}

bool DropletBodies::near_driven(const Box& path) const {
  return !driven_in_.empty() && path.overlaps(seen_) &&
         for_cells(seen_, cell_, cells_, path, [&](std::size_t c) { return driven_in_[c] != 0; });
}

bool DropletBodies::near_floating(const Body& body, const Box& path) {
  Box box;
  box.include(body.pose0.position);
  box.include(body.pose1.position);
  box.inflate(body.reach);
  return box.overlaps(path);
}

bool DropletBodies::near_any(const Box& path) const {
  if (near_driven(path)) return true;
  return std::any_of(bodies_.begin() + static_cast<std::ptrdiff_t>(driven_.size()), bodies_.end(),
                     [&](const Body& body) { return near_floating(body, path); });
}

Vec3 DropletBodies::corner(const Body& body, int vertex, double since) const {
  const Vec3& first = body.first[at(vertex)];
  if (body.floating) {
    const Vec3 from = body.pose0 * first;
    return from + since * (body.pose1 * first - from);
  }
  return first + (share0_ + since * (share1_ - share0_)) * (body.last[at(vertex)] - first);
}

DropletBodies::Hit DropletBodies::first_hit(const Vec3& from, const Vec3& to, double since) const {
  Hit out;
  const Box path = path_box(from, to);
  const bool driven = near_driven(path);
  for (const Body& body : bodies_) {
    if (body.tree.empty() || (body.floating ? !near_floating(body, path) : !driven)) continue;
    Box asked = path;
    if (body.floating) {
      asked = {};
      for (const RigidPose* pose : {&body.pose0, &body.pose1})
        for (const Vec3* p : {&from, &to}) asked.include(pose->rotation.conjugate() * (*p - pose->position));
      asked.inflate(2 * k_skin + body.slack);
    }
    body.tree.for_each_near(TreeBox::around(asked.lo, asked.hi), [&](int n) {
      const Triangle& t = body.triangles[at(n)];
      const MovingTriangle moving{{corner(body, t[0], since), corner(body, t[1], since), corner(body, t[2], since)},
                                  {corner(body, t[0], 1), corner(body, t[1], 1), corner(body, t[2], 1)}};
      Box box;
      for (const auto& ends : {moving.from, moving.to})
        for (const Vec3& p : ends) box.include(p);
      if (!box.overlaps(path)) return;
      const auto found = crossing_inwards(moving, from, to, k_skin);
      if (!found || found->share > out.share || (found->share == out.share && out.body)) return;
      static_cast<DropletCrossing&>(out) = *found;
      out.body = &body, out.triangle = n;
    });
  }
  return out;
}

void DropletBodies::meet(Droplet& d, const Vec3& start, double since, double dt) const {
  Vec3 from = start, to = d.place;
  std::array<Contact, k_most_contacts> contacts;
  std::size_t count = 0;
  Hit hit;
  for (int meeting = 0; meeting < k_most_meetings; ++meeting) {
    hit = first_hit(from, to, since);
    if (!hit.body) {
      d.place = to;
      return;
    }
    const Triangle& t = hit.body->triangles[at(hit.triangle)];
    Vec3 velocity = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k)
      velocity += hit.weight[k] / dt * (corner(*hit.body, t[k], 1) - corner(*hit.body, t[k], 0));
    if (count == k_most_contacts) {
      std::shift_left(contacts.begin(), contacts.end(), 1);
      --count;
    }
    contacts[count++] = {hit.normal, velocity};
    Vec3 along = d.velocity - velocity;
    const double against = std::min(0.0, along.dot(hit.normal));
    along -= against * hit.normal;
    const double slide = along.norm();
    if (slide > 0) along *= std::max(0.0, 1 + friction_ * against / slide);
    d.velocity = held_off(velocity + along, std::span(contacts).first(count));
    from += hit.share * (to - from) + k_skin * hit.normal;
    since += hit.share * (1 - since);
    to = from + (1 - since) * dt * d.velocity;
  }
  // Between surfaces that close on it.
  const Triangle& t = hit.body->triangles[at(hit.triangle)];
  const Vec3 a = corner(*hit.body, t[0], 1), b = corner(*hit.body, t[1], 1), c = corner(*hit.body, t[2], 1);
  d.place =
      hit.weight[0] * a + hit.weight[1] * b + hit.weight[2] * c + k_skin * (b - a).cross(c - a).stableNormalized();
  d.velocity = contacts[count - 1].velocity;
}

}  // namespace ft::inline solvers

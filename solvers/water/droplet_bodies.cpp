// See droplet_bodies.h. Triangles' corners go in straight lines in a step, as droplets do, so that a droplet is in a
// triangle's plane at a root of a cubic. Boxes of triangles stand for them in the tree: they hold all of their way.
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
constexpr int k_most_meetings = 8;  ///< of a droplet in a step; then it goes with what it met last
constexpr int k_sweeps = 8;
constexpr std::size_t k_most_contacts = 3;
/// Of a droplet's speed: what it may still go against a contact [1].
constexpr double k_still = 1e-9;

struct Contact {
  Vec3 normal, velocity;
  double against(const Vec3& v) const { return (v - velocity).dot(normal); }
};

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
  for (std::size_t b = 0; b < floats.size(); ++b) bodies_[driven_.size() + b].floating = floats[b];
}

void DropletBodies::set_step(double share0, double share1, std::span<const RigidPose> from,
                             std::span<const RigidPose> to) {
  CHECK(from.size() == to.size() && driven_.size() + from.size() == bodies_.size());
  share0_ = share0, share1_ = share1;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    bodies_[b].ready = false;
    if (b >= driven_.size()) bodies_[b].pose0 = from[b - driven_.size()], bodies_[b].pose1 = to[b - driven_.size()];
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
  make_ready(paths, std::sqrt(longest));
  parallel_for(droplets.size(), k_block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) meet(droplets[n], starts[n], since.empty() ? 0 : since[n], dt);
  });
}

void DropletBodies::make_ready(const Box& paths, double longest) {
  if (covered_.empty())
    for (const DrivenBody& d : driven_)
      for (std::size_t v = 0; v < d.from.size(); ++v) way_ = std::max(way_, (d.to[v] - d.from[v]).norm());
  const double span = share1_ - share0_;
  // A droplet goes no farther than its own way and twice that of what it meets.
  Box near = paths;
  near.inflate(longest + 2 * way_ * span + 2 * k_skin);
  const bool inside = !covered_.empty() && (covered_.lo.array() <= near.lo.array()).all() &&
                      (near.hi.array() <= covered_.hi.array()).all();
  if (!inside) {
    // So wide that the frame's other steps mostly find what they need.
    covered_.include(near);
    covered_.inflate(span > 0 ? (longest + 2 * way_ * span) / span : 0);
    for (Body& body : bodies_)
      if (body.driven) keep_near(body);
  }
  for (Body& body : bodies_) {
    if (body.ready) continue;
    if (body.floating) {
      double reach = 0;
      for (const Vec3& p : body.floating->positions) reach = std::max(reach, p.squaredNorm());
      body.box = {};
      body.box.include(body.pose0.position);
      body.box.include(body.pose1.position);
      body.box.inflate(std::sqrt(reach));
      if (!body.box.overlaps(near)) continue;
    }
    place(body);
  }
}

void DropletBodies::keep_near(Body& body) const {
  const DrivenBody& d = *body.driven;
  body.first.clear(), body.last.clear(), body.triangles.clear();
  body.tree = {};
  body.ready = false;
  std::vector<int> number(d.from.size(), -1);
  for (const Triangle& t : d.triangles) {
    Box box;
    for (const int v : t) {
      box.include(d.from[at(v)] - origin_);
      box.include(d.to[at(v)] - origin_);
    }
    if (!box.overlaps(covered_)) continue;
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

void DropletBodies::place(Body& body) const {
  body.ready = true;
  if (body.floating) {
    if (body.triangles.empty()) body.triangles = body.floating->triangles;
    const auto& in_body = body.floating->positions;
    const Mat3 turn0 = body.pose0.rotation.toRotationMatrix(), turn1 = body.pose1.rotation.toRotationMatrix();
    body.from.resize(in_body.size()), body.to.resize(in_body.size());
    for (std::size_t v = 0; v < in_body.size(); ++v) {
      body.from[v] = body.pose0.position + turn0 * in_body[v];
      body.to[v] = body.pose1.position + turn1 * in_body[v];
    }
  } else {
    body.from.resize(body.first.size()), body.to.resize(body.first.size());
    for (std::size_t v = 0; v < body.first.size(); ++v) {
      const Vec3 way = body.last[v] - body.first[v];
      body.from[v] = body.first[v] + share0_ * way;
      body.to[v] = body.first[v] + share1_ * way;
    }
  }
  body.box = {};
  body.corners.resize(2 * body.triangles.size());
  for (std::size_t n = 0; n < body.triangles.size(); ++n) {
    Box box;
    for (const int v : body.triangles[n]) {
      box.include(body.from[at(v)]);
      box.include(body.to[at(v)]);
    }
    body.corners[2 * n] = box.lo, body.corners[2 * n + 1] = box.hi;
    body.box.include(box);
  }
  if (body.triangles.empty()) return;
  if (!body.tree.empty()) {
    body.tree.refit(body.corners, body.boxes);
    return;
  }
  body.boxes.clear();
  for (int n = 0; n < static_cast<int>(body.triangles.size()); ++n) body.boxes.push_back({2 * n, 2 * n + 1, 2 * n + 1});
  body.tree = TriangleTree(body.corners, body.boxes);
}

DropletBodies::Hit DropletBodies::first_hit(const Vec3& from, const Vec3& to, double since) const {
  Hit out;
  Box path;
  path.include(from);
  path.include(to);
  path.inflate(2 * k_skin);
  const TreeBox asked = TreeBox::around(path.lo, path.hi);
  for (const Body& body : bodies_) {
    if (!body.ready || body.tree.empty() || !body.box.overlaps(path)) continue;
    body.tree.for_each_near(asked, [&](int n) {
      const Vec3 &lo = body.corners[at(2 * n)], &hi = body.corners[at(2 * n + 1)];
      if (!(lo.array() <= path.hi.array()).all() || !(path.lo.array() <= hi.array()).all()) return;
      const Triangle& t = body.triangles[at(n)];
      const auto corner = [&](std::size_t k) -> Vec3 {
        return body.from[at(t[k])] + since * (body.to[at(t[k])] - body.from[at(t[k])]);
      };
      const MovingTriangle moving{{corner(0), corner(1), corner(2)},
                                  {body.to[at(t[0])], body.to[at(t[1])], body.to[at(t[2])]}};
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
      velocity += hit.weight[k] / dt * (hit.body->to[at(t[k])] - hit.body->from[at(t[k])]);
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
  const Vec3 &a = hit.body->to[at(t[0])], &b = hit.body->to[at(t[1])], &c = hit.body->to[at(t[2])];
  d.place =
      hit.weight[0] * a + hit.weight[1] * b + hit.weight[2] * c + k_skin * (b - a).cross(c - a).stableNormalized();
  d.velocity = contacts[count - 1].velocity;
}

}  // namespace ft::inline solvers

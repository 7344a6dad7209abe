// See hair_solver.h: what four strands do in a step.
#include <algorithm>
#include <cmath>

#include "solvers/hair/hair_group.h"

namespace ft::inline solvers {
namespace {

/// Contact stiffness by mass: k = 20 m / (2/3 h)^2 at h = 1/96 s, whatever the step is: it must not move a groom.
constexpr double k_stiffness = 20 * (1.5 * 96) * (1.5 * 96);
/// Friction is viscous below this speed [m/s].
constexpr double k_slow = 2e-3;
/// Beyond its thickness and what it goes in the step, a vertex looks so much farther for what is near [m]; and no
/// farther than the second.
constexpr double k_look = 2e-3, k_farthest = 0.06;
constexpr double k_hold = 10;          ///< of what is tied, by a strand's stiffness along [1]
constexpr std::size_t k_together = 1;  ///< vertices that look for triangles together

Vec3 vec(const double* p) {
  return {p[0], p[1], p[2]};
}
void put(double* p, const Vec3& v) {
  p[0] = v.x(), p[1] = v.y(), p[2] = v.z();
}

}  // namespace

/// Planes for the vertices of one strand. x: at the start; next: where they would be, going on freely with their roots.
void HairSolver::add_contacts(std::size_t group, int lane, std::span<const Vec3> x, std::span<const Vec3> next,
                              Work& w) const {
  const std::size_t n = at(n_), s = strand_of(group, lane);
  const HairMaterial& material = setup_.material;
  const double way = bodies_.way();
  for (std::size_t first = at(std::max(2, setup_.strands[s].held + 1)); first < n; first += k_together) {
    const std::size_t last = std::min(first + k_together, n);
    double reach[k_together];
    Box box;
    for (std::size_t i = first; i < last; ++i) {
      reach[i - first] = std::min(material.thickness + k_look + way + (next[i] - x[i]).norm(), k_farthest);
      const Vec3 grown = Vec3::Constant(reach[i - first]);
      box.include((x[i] - grown).eval()), box.include((x[i] + grown).eval());
    }
    find_candidates(bodies_, box, w.candidates);
    if (w.candidates.empty()) continue;
    for (std::size_t i = first; i < last; ++i) {
      NearSurface near[k_contacts];
      const int count = find_nearest(bodies_, w.candidates, x[i], reach[i - first], k_contacts, near);
      const double gap = gaps_[s * n + i];
      const double keeps = std::clamp(0.98 * gap, k_least_reach, material.thickness);
      const double shift = std::min(0.0, gap - k_least_reach);
      for (int c = 0; c < count; ++c) {
        const NearSurface& surface = near[c];
        const Triangle& t = bodies_.triangles(surface.body)[at(surface.triangle)];
        const auto a = bodies_.before(surface.body), b = bodies_.after(surface.body);
        const Mat3 turn = triangle_frame(b[at(t[0])], b[at(t[1])], b[at(t[2])]) *
                          triangle_frame(a[at(t[0])], a[at(t[1])], a[at(t[2])]).transpose();
        if (!turn.allFinite()) continue;
        Vec3 from = Vec3::Zero(), to = Vec3::Zero();
        for (int k = 0; k < 3; ++k)
          from += surface.weights[k] * a[at(t[at(k)])], to += surface.weights[k] * b[at(t[at(k)])];
        const Vec3 normal = turn * surface.normal;
        HairContact<Lanes>& contact = w.around.contacts[k_contacts * i + at(c)];
        set_lane(contact.normal, lane, normal);
        contact.offset[lane] = normal.dot(to) + shift;
        contact.reach[lane] = keeps;
        contact.stiffness[lane] = k_stiffness * groups_[group].rod.mass[i][lane];
        set_lane(contact.carried, lane, to + turn * (x[i] - from));
        contact.friction[lane] = c == 0 ? material.friction * bodies_.friction(surface.body) : 0;
        w.around.touches = true;
      }
    }
  }
}

void HairSolver::advance_group(const Step& step, std::size_t g, Work& w) const {
  const std::size_t n = at(n_);
  const Rod<Lanes>& rod = groups_[g].rod;
  const double h = step.h, implicit = step.implicit();
  const HairMaterial& material = setup_.material;
  w.pose.x.resize(n), w.pose.director.resize(n - 1), w.start.x.resize(n), w.start.director.resize(n - 1);
  w.around.pull.assign(n, Lanes{}), w.around.goal.resize(n), w.tension.resize(n);
  w.around.contacts.assign(k_contacts * n, HairContact<Lanes>());
  w.around.touches = false;
  w.around.friction_speed_way = k_slow * h;
  w.x.resize(n), w.next.resize(n);
  for (int lane = 0; lane < k_lanes; ++lane) {
    const std::size_t s = strand_of(g, lane), base = s * n;
    const RootFrame &before = step.roots_before[s], &now = step.roots_now[s], &after = step.roots_after[s];
    for (std::size_t i = 0; i < n; ++i) {
      const double* state = step.x + 3 * (base + i);
      const Vec3 x = vec(state), x_before = vec(step.x_before + 3 * (base + i)), v = vec(step.v + 3 * (base + i)),
                 v_before = vec(step.v_before + 3 * (base + i));
      const Vec3 with_root = after.carry(now, x), from_root = before.carry(now, x);
      const double mass = rod.mass[i][lane];
      // Inertia and gravity; drag towards the root; drag towards the air.
      const Vec3 path = step.first ? x : Vec3((4 * x - x_before) / 3);
      const Vec3 free =
          path + implicit * (step.first ? v : Vec3((4 * v - v_before) / 3)) + implicit * implicit * setup_.gravity;
      const Vec3 still = step.first ? with_root : Vec3(with_root + (from_root - x_before) / 3);
      const double inertia = mass / (implicit * implicit), slow = mass * material.drag / implicit;
      double pull = inertia + slow;
      Vec3 goal = inertia * free + slow * still;
      const Vec3 air = step.air ? step.air->velocity(x) : Vec3::Zero();
      const double blown = mass * material.air_drag * (air - v).norm() / implicit;
      pull += blown;
      goal += blown * (path + implicit * air);
      if (static_cast<int>(i) <= setup_.strands[s].held) {  // counts the ghost
        const double holds = k_hold * rod.stretch[lane] / rod.length[0][lane];
        goal += holds * with_root;
        pull += holds;
      }
      w.around.pull[i][lane] = pull;
      set_lane(w.around.goal[i], lane, goal / pull);
      w.x[i] = x;
      w.next[i] = static_cast<int>(i) <= std::max(1, setup_.strands[s].held)
                      ? with_root
                      : Vec3(with_root + h * v - (x - from_root));
      set_lane(w.start.x[i], lane, x);
      set_lane(w.pose.x[i], lane, w.next[i]);
      w.tension[i][lane] = step.tension[base + i];
    }
    const Mat3 turn = after.turn * now.turn.transpose();
    for (std::size_t j = 0; j + 1 < n; ++j) {
      const Vec3 m = vec(step.m + 3 * (s * (n - 1) + j));
      set_lane(w.start.director[j], lane, m);
      const Vec3 e = turn * (w.x[j + 1] - w.x[j]).normalized(), f = (w.next[j + 1] - w.next[j]).normalized();
      set_lane(w.pose.director[j], lane, plain(carried_director(plain(Vec3(turn * m)), plain(e), plain(f))));
    }
    add_contacts(g, lane, w.x, w.next, w);
  }
  strains_of(w.start, w.since);
  const RodStepReport report = w.step.run(rod, w.around, w.since, material.damping / h, w.tension, w.pose);
  step.iterations[g] += report.iterations;
  for (int lane = 0; lane < k_lanes && k_lanes * g + at(lane) < setup_.strands.size(); ++lane) {
    const std::size_t s = strand_of(g, lane), base = s * n;
    step.unsettled[g] += report.settled[lane] ? 0 : 1;
    for (std::size_t i = 0; i < n; ++i) {
      double *x = step.x + 3 * (base + i), *x_before = step.x_before + 3 * (base + i), *v = step.v + 3 * (base + i);
      const Vec3 old = vec(x), older = vec(x_before), now = lane_of(w.pose.x[i], lane);
      put(step.v_before + 3 * (base + i), vec(v));
      put(v, step.first ? Vec3((now - old) / h) : Vec3((3 * now - 4 * old + older) / (2 * h)));
      put(x_before, old);
      put(x, now);
      step.tension[base + i] = w.tension[i][lane];
      if (i + 1 < n) put(step.m + 3 * (s * (n - 1) + i), lane_of(w.pose.director[i], lane));
    }
  }
}

}  // namespace ft::inline solvers

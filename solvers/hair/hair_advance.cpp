// See hair_solver.h: what four strands do in a step.
#include <algorithm>
#include <cmath>

#include "solvers/hair/hair_group.h"
#include "solvers/hair/sheet_passage.h"

namespace ft::inline solvers {
namespace {

/// Contact stiffness by mass: k = 20 m / (2/3 h)^2 at h = 1/96 s, whatever the step is: it must not move a groom. What
/// was combed nearer than its thickness is met as firmly within what it keeps; but nearer than k_firm [m] a contact
/// becomes stiffer only where something presses through it (RodStep).
constexpr double k_stiffness = 20 * (1.5 * 96) * (1.5 * 96), k_firm = 2e-4;
/// Friction is viscous below this speed [m/s].
constexpr double k_slow = 2e-3;
/// Beyond its thickness and what it goes in the step, a vertex looks so much farther for what is near [m]; and no
/// farther than the second.
constexpr double k_look = 2e-3, k_farthest = 0.06;
constexpr double k_hold = 10;     ///< of what is tied, by a strand's stiffness along [1]
constexpr int k_most_pieces = 8;  ///< of a step that does not settle
constexpr int k_most_rounds = 8;  ///< in which a step is done again because segments went through a sheet

Vec3 vec(const double* p) {
  return {p[0], p[1], p[2]};
}
void put(double* p, const Vec3& v) {
  p[0] = v.x(), p[1] = v.y(), p[2] = v.z();
}

/// A plane on a body at the end of the step, and the rigid motion that took it there.
struct PlaneAfter {
  Vec3 normal, place, from;
  Mat3 turn;
};
PlaneAfter plane_after(const HairBodies& bodies, const NearSurface& surface) {
  const Triangle& t = bodies.triangles(surface.body)[at(surface.triangle)];
  const auto a = bodies.before(surface.body), b = bodies.after(surface.body);
  PlaneAfter out;
  out.turn = triangle_frame(b[at(t[0])], b[at(t[1])], b[at(t[2])]) *
             triangle_frame(a[at(t[0])], a[at(t[1])], a[at(t[2])]).transpose();
  out.from = out.place = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    out.from += surface.weights[k] * a[at(t[at(k)])], out.place += surface.weights[k] * b[at(t[at(k)])];
  out.normal = out.turn * surface.normal;
  return out;
}

/// At a share of the way from one frame to the other, or beyond.
RootFrame between(const RootFrame& a, const RootFrame& b, double share) {
  if (share == 0) return a;
  if (share == 1) return b;
  const Eigen::AngleAxisd turn(Mat3(b.turn * a.turn.transpose()));
  return {a.place + share * (b.place - a.place),
          Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix() * a.turn};
}

}  // namespace

void HairSolver::load(const Step& step, std::size_t g, Work& w) const {
  const std::size_t n = at(n_);
  for (int lane = 0; lane < k_lanes; ++lane) {
    StrandNow& now = w.strands[at(lane)];
    const std::size_t s = strand_of(g, lane), base = s * n;
    now.x.resize(n), now.x_before.resize(n), now.v.resize(n), now.v_before.resize(n), now.m.resize(n - 1);
    now.tension.assign(step.tension + base, step.tension + base + n);
    for (std::size_t i = 0; i < n; ++i) {
      now.x[i] = vec(step.x + 3 * (base + i)), now.x_before[i] = vec(step.x_before + 3 * (base + i));
      now.v[i] = vec(step.v + 3 * (base + i)), now.v_before[i] = vec(step.v_before + 3 * (base + i));
      if (i + 1 < n) now.m[i] = vec(step.m + 3 * (s * (n - 1) + i));
    }
  }
}

/// Where the step began becomes what was before.
void HairSolver::store(const Step& step, std::size_t g, int lane, const StrandNow& now) const {
  const std::size_t n = at(n_), s = strand_of(g, lane), base = s * n;
  for (std::size_t i = 0; i < n; ++i) {
    double *x = step.x + 3 * (base + i), *v = step.v + 3 * (base + i);
    put(step.x_before + 3 * (base + i), vec(x)), put(step.v_before + 3 * (base + i), vec(v));
    put(x, now.x[i]), put(v, now.v[i]);
    step.tension[base + i] = now.tension[i];
    if (i + 1 < n) put(step.m + 3 * (s * (n - 1) + i), now.m[i]);
  }
}

/// Planes for the vertices of one strand, as it is at the start of the step.
void HairSolver::add_contacts(const Step& step, std::size_t group, int lane, Work& w) const {
  const std::size_t n = at(n_), s = strand_of(group, lane);
  const HairMaterial& material = setup_.material;
  const StrandNow& strand = w.strands[at(lane)];
  const std::size_t first = at(std::max(2, setup_.strands[s].held + 1));
  // Of the vertex before; the last held one goes with its root.
  Vec3 goes_before = step.roots_after[s].carry(step.roots_now[s], strand.x[first - 1]) - strand.x[first - 1];
  double gap_before = 1;
  for (std::size_t i = first; i < n; ++i) {
    const Vec3& x = strand.x[i];
    // Where it would be, going on freely with its root.
    const Vec3 goes = step.roots_after[s].carry(step.roots_now[s], x) - x + step.h * strand.v[i] -
                      (x - step.roots_before[s].carry(step.roots_now[s], x));
    const double gap = gaps_[s * n + i];
    const double reach = material.thickness + k_look;
    find_candidates(bodies_, {x, x}, std::min(reach + (goes - bodies_.common()).norm(), k_farthest), w.candidates);
    NearSurface near[k_contacts];
    const int count = find_nearest(bodies_, w.candidates, x, reach, k_contacts, near, &goes);
    const double gap_now = count > 0 ? near[0].gap : 1.0;
    if (segment_gaps_[s * n + i] > k_least_reach)
      add_segment_contact(group, lane, i, goes_before, goes, std::max(gap_before, gap_now) < reach, w);
    goes_before = goes, gap_before = gap_now;
    const double keeps = std::clamp(0.98 * gap, k_least_reach, material.thickness);
    const double shift = std::min(0.0, gap - k_least_reach);
    for (int c = 0; c < count; ++c) {
      const NearSurface& surface = near[c];
      const PlaneAfter plane = plane_after(bodies_, surface);
      HairContact<Lanes>& contact = w.contacts[k_contacts * i + at(c)];
      set_lane(contact.normal, lane, plane.normal);
      contact.offset[lane] = plane.normal.dot(plane.place) + shift;
      contact.reach[lane] = keeps;
      contact.stiffness[lane] = k_stiffness * material.thickness / std::max(keeps, k_firm) * rods_[group].mass[i][lane];
      set_lane(w.moved[k_contacts * i + at(c)], lane, plane.place + plane.turn * (x - plane.from) - x);
      contact.friction[lane] = c == 0 ? material.friction * bodies_.friction(surface.body) : 0;
      w.around.touches = true;
    }
  }
}

/// The plane of a place on a body as a contact of the segment before a vertex, whose ends were at a and b.
void HairSolver::put_segment_contact(std::size_t group, int lane, std::size_t i, int slot, const NearSurface& surface,
                                     double share, const Vec3& a, const Vec3& b, Work& w) const {
  const double thickness = setup_.material.thickness;
  const PlaneAfter plane = plane_after(bodies_, surface);
  const double keeps = std::clamp(0.98 * segment_gaps_[strand_of(group, lane) * at(n_) + i], k_least_reach, thickness);
  const std::size_t own = at(k_segment_contacts) * i + at(slot);
  SegmentContact<Lanes>& contact = w.segments[own];
  set_lane(contact.normal, lane, plane.normal);
  contact.share[lane] = share;
  contact.offset[lane] = plane.normal.dot(plane.place);
  contact.reach[lane] = keeps;
  contact.stiffness[lane] = k_stiffness * thickness / std::max(keeps, k_firm) * rods_[group].mass[i][lane];
  const Vec3 place = a + share * (b - a);
  set_lane(w.segments_moved[own], lane, plane.place + plane.turn * (place - plane.from) - place);
  w.around.touches = true;
}

/// A plane for the segment before a vertex, where it is near an edge over which it could cut; and where both its ends
/// lie on a body, one for its middle: a flat ridge could be in it.
void HairSolver::add_segment_contact(std::size_t group, int lane, std::size_t i, const Vec3& before_goes,
                                     const Vec3& goes, bool lies, Work& w) const {
  const Vec3 &a = w.strands[at(lane)].x[i - 1], &b = w.strands[at(lane)].x[i];
  if (const auto edge = find_nearest_edge(bodies_, a, b, setup_.material.thickness + k_look, &before_goes, &goes))
    put_segment_contact(group, lane, i, 0, edge->surface, edge->share, a, b, w);
  NearSurface near;
  if (lies && find_nearest(bodies_, w.candidates, 0.5 * (a + b), setup_.material.thickness, 1, &near, &goes) > 0)
    put_segment_contact(group, lane, i, 1, near, 0.5, a, b, w);
}

/// Of the strands in the work, from where they are; they are where it ends after it.
RodStepReport HairSolver::run_piece(const Step& step, const Piece& piece, std::size_t g, Work& w) const {
  const std::size_t n = at(n_);
  const Rod<Lanes>& rod = rods_[g];
  const double h = piece.h, implicit = piece.implicit();
  const HairMaterial& material = setup_.material;
  w.pose.x.resize(n), w.pose.director.resize(n - 1), w.start.x.resize(n), w.start.director.resize(n - 1);
  w.around.pull.assign(n, Lanes{}), w.around.goal.resize(n), w.tension.resize(n);
  w.around.contacts = w.contacts;
  w.around.segments = w.segments;
  w.around.friction_speed_way = k_slow * h;
  for (int lane = 0; lane < k_lanes; ++lane) {
    const StrandNow& strand = w.strands[at(lane)];
    const std::size_t s = strand_of(g, lane);
    const RootFrame now = between(step.roots_now[s], step.roots_after[s], piece.from),
                    after = between(step.roots_now[s], step.roots_after[s], piece.to);
    const RootFrame before = piece.from > 0 ? between(step.roots_now[s], step.roots_after[s], 2 * piece.from - piece.to)
                                            : between(step.roots_now[s], step.roots_before[s], piece.to);
    std::vector<Vec3> next(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 &x = strand.x[i], &v = strand.v[i], &x_before = strand.x_before[i], &v_before = strand.v_before[i];
      const Vec3 with_root = after.carry(now, x), from_root = before.carry(now, x);
      const double mass = rod.mass[i][lane];
      // Inertia and gravity; drag towards the root; drag towards the air.
      const Vec3 path = piece.first ? x : Vec3((4 * x - x_before) / 3);
      const Vec3 free =
          path + implicit * (piece.first ? v : Vec3((4 * v - v_before) / 3)) + implicit * implicit * setup_.gravity;
      const Vec3 still = piece.first ? with_root : Vec3(with_root + (from_root - x_before) / 3);
      const double inertia = mass / (implicit * implicit), slow = mass * material.drag / implicit;
      double pull = inertia + slow;
      Vec3 goal = inertia * free + slow * still;
      if (i > 0 && !step.push.empty()) {
        const std::size_t own = s * (n - 1) + i - 1;
        const double along = mass * material.mutual_drag / implicit;
        pull += along;
        goal += along * (path + implicit * step.flow[own]) + mass * step.push[own];
      }
      const Vec3 air = step.air ? step.air->velocity(x) : Vec3::Zero();
      const double blown = mass * material.air_drag * (air - v).norm() / implicit;
      pull += blown;
      goal += blown * (path + implicit * air);
      const bool held = static_cast<int>(i) <= setup_.strands[s].held;  // counts the ghost
      if (held) {
        const double holds = k_hold * rod.stretch[lane] / rod.length[0][lane];
        goal += holds * with_root;
        pull += holds;
      }
      w.around.pull[i][lane] = pull;
      set_lane(w.around.goal[i], lane, goal / pull);
      next[i] = held ? with_root : Vec3(with_root + h * v - (x - from_root));
      set_lane(w.start.x[i], lane, x);
      set_lane(w.pose.x[i], lane, next[i]);
      w.tension[i][lane] = strand.tension[i];
      for (std::size_t c = k_contacts * i; c < k_contacts * (i + 1); ++c) {
        HairContact<Lanes>& contact = w.around.contacts[c];
        const Vec3 moved = lane_of(w.moved[c], lane), normal = lane_of(contact.normal, lane);
        contact.offset[lane] -= (1 - piece.to) * moved.dot(normal);
        set_lane(contact.carried, lane, x + (piece.to - piece.from) * moved);
      }
      for (std::size_t c = k_segment_contacts * i; c < k_segment_contacts * (i + 1); ++c) {
        SegmentContact<Lanes>& segment = w.around.segments[c];
        segment.offset[lane] -= (1 - piece.to) * lane_of(w.segments_moved[c], lane).dot(lane_of(segment.normal, lane));
      }
    }
    const Mat3 turn = after.turn * now.turn.transpose();
    for (std::size_t j = 0; j + 1 < n; ++j) {
      set_lane(w.start.director[j], lane, strand.m[j]);
      const Vec3 e = turn * (strand.x[j + 1] - strand.x[j]).normalized(), f = (next[j + 1] - next[j]).normalized();
      set_lane(w.pose.director[j], lane, plain(carried_director(plain(Vec3(turn * strand.m[j])), plain(e), plain(f))));
    }
  }
  strains_of(w.start, w.since);
  const RodStepReport report = w.step.run(rod, w.around, w.since, material.damping / h, w.tension, w.pose);
  for (int lane = 0; lane < k_lanes; ++lane) {
    StrandNow& strand = w.strands[at(lane)];
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 now = lane_of(w.pose.x[i], lane), old = strand.x[i];
      const Vec3 v = piece.first ? Vec3((now - old) / h) : Vec3((3 * now - 4 * old + strand.x_before[i]) / (2 * h));
      strand.x_before[i] = old, strand.v_before[i] = strand.v[i];
      strand.x[i] = now, strand.v[i] = v;
      strand.tension[i] = w.tension[i][lane];
      if (i + 1 < n) strand.m[i] = lane_of(w.pose.director[i], lane);
    }
  }
  return report;
}

/// Of the strands that are open, from the start of the step, with the contacts in the work: where it ends.
void HairSolver::solve_step(const Step& step, std::size_t g, std::array<bool, k_lanes> open, Work& w) const {
  load(step, g, w);
  RodStepReport report = run_piece(step, {.h = step.h, .first = step.first}, g, w);
  step.iterations[g] += report.iterations;
  const auto settle = [&](bool last) {
    bool any = false;
    for (std::size_t lane = 0; lane < k_lanes; ++lane) {
      if (open[lane] && (report.settled[lane] || last)) w.settled[lane] = w.strands[lane];
      if (open[lane] && !report.settled[lane] && last) ++step.unsettled[g];
      open[lane] = open[lane] && !report.settled[lane] && !last;
      any = any || open[lane];
    }
    return any;
  };
  for (int pieces = 2; settle(pieces > k_most_pieces); pieces *= 2) {
    load(step, g, w);
    report = RodStepReport();
    for (int p = 0; p < pieces; ++p) {
      const RodStepReport one = run_piece(
          step, {.h = step.h / pieces, .first = true, .from = double(p) / pieces, .to = double(p + 1) / pieces}, g, w);
      step.iterations[g] += one.iterations;
      for (int lane = 0; lane < k_lanes; ++lane) report.settled[lane] = report.settled[lane] && one.settled[lane];
    }
  }
}

/// A plane where each segment of a strand went through a sheet in the step, if any did.
int HairSolver::bar_passages(const Step& step, std::size_t g, int lane, int round, Work& w) const {
  const std::size_t n = at(n_), s = strand_of(g, lane), base = s * n;
  const StrandNow& end = w.settled[at(lane)];
  int found = 0;
  for (std::size_t i = at(std::max(2, setup_.strands[s].held + 1)); i < n; ++i) {
    const auto before = [&](std::size_t k) { return vec(step.x + 3 * (base + k)); };
    const auto passage = find_sheet_passage(bodies_, {before(i - 1), before(i), end.x[i - 1], end.x[i]});
    if (!passage) continue;
    ++found;
    put_segment_contact(g, lane, i, k_near_contacts + round % k_passages, passage->surface, passage->share,
                        before(i - 1), before(i), w);
  }
  return found;
}

void HairSolver::advance_group(const Step& step, std::size_t g, Work& w) const {
  load(step, g, w);
  w.contacts.assign(at(k_contacts * n_), HairContact<Lanes>());
  w.moved.assign(at(k_contacts * n_), V3<Lanes>());
  w.segments.assign(at(k_segment_contacts * n_), SegmentContact<Lanes>());
  w.segments_moved.assign(at(k_segment_contacts * n_), V3<Lanes>());
  w.around.touches = false;
  for (int lane = 0; lane < k_lanes; ++lane) add_contacts(step, g, lane, w);
  std::array<bool, k_lanes> open;
  for (int lane = 0; lane < k_lanes; ++lane) open[at(lane)] = k_lanes * g + at(lane) < setup_.strands.size();
  const std::array<bool, k_lanes> own = open;
  for (int round = 0; std::ranges::count(open, true) > 0; ++round) {
    solve_step(step, g, open, w);
    if (!bodies_.has_sheets()) break;
    for (int lane = 0; lane < k_lanes; ++lane) {
      const int passages = open[at(lane)] ? bar_passages(step, g, lane, round, w) : 0;
      open[at(lane)] = passages > 0 && round < k_most_rounds;
      if (round == k_most_rounds) step.passages[g] += passages;
    }
  }
  for (int lane = 0; lane < k_lanes; ++lane)
    if (own[at(lane)]) store(step, g, lane, w.settled[at(lane)]);
}

}  // namespace ft::inline solvers

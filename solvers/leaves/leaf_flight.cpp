// See leaves_solver.h: what one leaf does in a frame.
#include <algorithm>
#include <cmath>

#include "solvers/leaves/leaf_certificate.h"
#include "solvers/leaves/leaf_frame.h"
#include "solvers/leaves/leaf_sleep.h"

namespace ft::inline solvers {
namespace {

/// In the steps of a leaf near something, its points go no farther than this [m], in at most so many steps of a slice.
constexpr double k_near_way = 0.004;
constexpr int k_near_steps = 48;
constexpr double k_float_share = 0.5;  ///< of a slice, that a floating leaf goes at once where no body is near [1]
constexpr int k_flight_steps = 200;    ///< of a slice, at most
/// Beyond the margin, a gap that counts as touching [m].
constexpr double k_touch = 0.8e-3;
/// What lies flatter than the first on its ground is under the law of lying leaves, beyond the second of flying ones;
/// sines [1].
constexpr double k_flat = 0.17, k_tilted = 0.34;
/// The air between a lying leaf and its ground resists its turning and rising [1/s]. Tuned: leaves that settle do so
/// within half a second.
constexpr double k_cushion = 12;

Quat turned(const Quat& q, const Vec3& angle) {
  const double size = angle.norm();
  if (size < 1e-15) return q;
  return (Quat(Eigen::AngleAxisd(size, angle / size)) * q).normalized();
}

}  // namespace

void LeavesSolver::place_leaf(const Model& model, const Moving& m, std::vector<Vec3>& out) {
  const Mat3 turn = m.q.toRotationMatrix();
  if (model.bending)
    bend(*model.bending, model.shape, m.bent, out);
  else
    out = model.shape.positions;
  for (Vec3& p : out) p = m.x + turn * p;
}

BendingStep LeavesSolver::step_modes(const Model& model, const PlateAir& air, double time, const Moving& m,
                                     ContactScratch& s) {
  const Mat3 turn = m.q.toRotationMatrix();
  bend(*model.bending, model.shape, m.bent, s.own_places);
  bend_directions(*model.bending, model.shape, m.bent, s.directions);
  const BendingLoad load = bending_load(*model.bending, model.shape, model.plate, s.own_places, s.directions,
                                        turn.transpose() * (air.velocity - m.v), turn.transpose() * m.spin);
  for (Vec3& d : s.directions) d = turn * d;
  return step_bending(*model.bending, load, time, 1, m.bent, m.bending);
}

/// At least so far is it from here to the water, and what the water can rise until then [m].
double LeavesSolver::gap_to_water(const Model& model, const Moving& m, int slice, double from) const {
  const auto now = waters_.under(m.x, model.floating.reach, slice, from, false),
             then = waters_.under(m.x, model.floating.reach, slice, 1, false);
  if (!now || !then) return std::numeric_limits<double>::infinity();
  return m.x.y() - model.shape.radius * (1 + now->slope.norm()) - std::max(now->level, then->level);
}

int LeavesSolver::near_step(std::size_t leaf, const ContactStep& step, const PlateAir& air, Moving& m,
                            ContactScratch& s, Touch& touch) const {
  const Model& model = leaves_[leaf];
  place_leaf(model, m, s.rim);
  find_contacts(bodies_, setup_.grounds, model.shape, step, m.x, s);
  // The water at both ends of the step: how the leaf is on it now, and what it meets.
  const auto now = waters_.under(m.x, model.floating.reach, step.slice, step.from, floats(m)),
             water = waters_.under(m.x, model.floating.reach, step.slice, step.to, floats(m));
  double depth = 0, gap = 0;
  if (now) {
    depth = float_depth(model.floating, *now, floating(m), model.margin);
    gap = std::numeric_limits<double>::infinity();
    for (const Vec3& p : s.rim) gap = std::min(gap, p.y() - now->height_at(m.x, p) - model.margin);
  }
  m.afloat = water && floats(m) ? next_afloat(m.afloat, depth, gap, false) : Afloat::k_no;
  if (water && !floats(m)) meet_water(*water, step, m.x, s);

  // How it lies.
  Vec3 ground = Vec3::Zero(), ground_velocity = Vec3::Zero();
  int touching = 0;
  bool on_water = false;
  touch = {touch.impulses};
  for (const LeafContact& c : s.contacts)
    if (c.gap < step.margin + k_touch) {
      ground += c.normal, ground_velocity += c.velocity;
      ++touching;
      touch.moves = touch.moves || c.moves;
      on_water = on_water || c.met < 0;
    }
  touch.lies = touching > 0;
  double lying = 0;
  if (touching > 0 && ground.norm() > 0.3 * touching) {
    ground.normalize();
    ground_velocity /= touching;
    const double sine = (m.q * Vec3::UnitY()).cross(ground).norm();
    lying = std::clamp((k_tilted - sine) / (k_tilted - k_flat), 0.0, 1.0);
  }
  if (water && !floats(m)) {
    m.afloat = next_afloat(m.afloat, depth, gap, on_water && lying > 0);
    if (floats(m)) {
      std::erase_if(s.contacts, [](const LeafContact& c) { return c.met < 0; });
      FloatingMotion motion = floating(m);
      enter_water(model.plate, model.floating, *now, motion);
      m.v = motion.velocity, m.spin = motion.spin;
    }
  }

  const double h = step.time;
  Moving flown = m;
  int steps = 0;
  PlateAir past = air;  // what bends it
  if (floats(m)) {
    FloatingMotion motion = floating(m);
    advance_float(model.plate, model.floating, m.afloat, setup_.gravity, air.velocity, *now, *water, depth, h, motion);
    flown.v = motion.velocity, flown.spin = motion.spin;
    past = {m.v, Vec3::Zero()};
    lying = 0, touch.lies = false;
  } else if (lying < 1) {
    PlateMotion motion{m.x, m.q, m.q.conjugate() * (m.v - air.velocity), m.q.conjugate() * m.spin};
    steps = advance_plate(model.plate, setup_.gravity, air, h, k_flight_steps, motion);
    flown = {motion.place,
             motion.turn * motion.velocity + air.velocity + h * air.change,
             motion.turn * motion.spin,
             motion.turn,
             m.bent,
             m.bending,
             m.afloat};
  }
  BendingStep bending;
  if (model.bending) {
    bending = step_modes(model, past, h, m, s);
    flown.bending = bending.speed;
    bend_by(h * flown.bending, flown.bent, flown.bending);
  }
  const Mat3 turn = m.q.toRotationMatrix();
  const Mat3 inverse_inertia = turn * model.plate.inertia.cwiseInverse().asDiagonal() * turn.transpose();
  if (lying > 0) {
    for (Vec3& p : s.rim) p -= m.x;
    const LyingForce f = lying_force(setup_.prototypes[at(setup_.leaves[leaf].prototype)], model.plate, ground,
                                     air.velocity - m.v, s.rim);
    const double damp = 1 / (1 + h * k_cushion);
    Vec3 v = m.v + h * (setup_.gravity + f.force / model.plate.mass) - ground_velocity;
    const double rising = v.dot(ground);
    v += (damp - 1) * std::max(rising, 0.0) * ground + ground_velocity;
    const Vec3 spin = damp * (m.spin + h * (inverse_inertia * f.torque));
    flown.v = lying * v + (1 - lying) * flown.v;
    flown.spin = lying * spin + (1 - lying) * flown.spin;
  }
  LeafVelocity kept{flown.v, flown.spin, flown.bending};
  bool pushed = lying > 0 || floats(m);
  LeafVelocity way = kept;
  if (!s.contacts.empty()) {
    bool any = false;
    const LeafMobility mobility{1 / model.plate.mass, inverse_inertia, model.bending ? &bending.mobility : nullptr};
    way = solve_contacts(s.contacts, mobility, h, step.margin, kept, s, kept, any);
    pushed = pushed || any;
    if (any) {
      const std::size_t met = at(bodies_.count()) + setup_.grounds.size();
      touch.impulses->resize(met * LeafBodies::k_slices);
      for (std::size_t c = 0; c < s.contacts.size(); ++c)
        if (s.contacts[c].met >= 0)
          (*touch.impulses)[at(step.slice) * met + at(s.contacts[c].met)].add(m.x + s.contacts[c].arm, -s.impulse[c]);
    }
  }
  if (!pushed) {
    m = flown;
    return std::max(steps, 1);
  }
  m.x += h * way.linear;
  m.q = turned(m.q, h * way.angular);
  m.v = kept.linear;
  m.spin = kept.angular;
  if (model.bending) {
    m.bending = kept.bending;
    bend_by(h * way.bending, m.bent, m.bending);
  }
  return std::max(steps, 1);
}

int LeavesSolver::advance_slice(const Frame& frame, std::size_t leaf, int slice, Moving& m, ContactScratch& s,
                                Touch& touch) const {
  const Model& model = leaves_[leaf];
  const double time = (frame.t1 - frame.t0) / LeafBodies::k_slices, radius = model.shape.radius;
  PlateAir air;
  if (frame.has_wind) {
    air.velocity = frame.air[at(slice)]->velocity(m.x);
    const Vec3 next = frame.air[at(slice) + 1]->velocity(m.x + time * m.v);
    air.change = (next - air.velocity) / time;
    if (!air.velocity.allFinite() || !air.change.allFinite()) air = {};
  }
  // How far it can get in this slice: as fast as it is, or as the air takes it.
  const double speed = m.v.norm() + (air.velocity - m.v).norm() + time * (air.change.norm() + setup_.gravity.norm());
  const double reach = radius + model.margin + time * speed;
  find_near(bodies_, slice, m.x, reach, s.near);
  bool near = !s.near.empty();
  for (const LeafGround& ground : setup_.grounds) near = near || m.x.y() - reach < ground.height;
  near = near || floats(m) || gap_to_water(model, m, slice, 0) < reach - radius;
  int steps = 0;
  touch = {touch.impulses};
  if (!near) {
    PlateMotion motion{m.x, m.q, m.q.conjugate() * (m.v - air.velocity), m.q.conjugate() * m.spin};
    const Moving before = m;
    steps = advance_plate(model.plate, setup_.gravity, air, time, k_flight_steps, motion);
    m = {motion.place,
         motion.turn * motion.velocity + air.velocity + time * air.change,
         motion.turn * motion.spin,
         motion.turn,
         m.bent,
         m.bending,
         m.afloat};
    if (model.bending)
      advance_bending(*model.bending, model.shape, model.plate, before.q.conjugate() * (air.velocity - before.v),
                      before.q.conjugate() * before.spin, time, m.bent, m.bending);
    return steps;
  }
  double way = 0;
  for (const NearTriangle& n : s.near) way = std::max(way, bodies_.way(n.body, slice));
  for (double done = 0; done < 1 - 1e-9;) {
    const double bending = m.bending.cwiseAbs().sum() * radius;
    const double turning = m.spin.norm() * radius + bending, gusting = 0.1 * (air.velocity - m.v).norm();
    double fastest = m.v.norm() + turning + gusting, share = 1;
    if (s.near.empty()) {
      // Half-spaces: what goes along them meets nothing new, and until it gets there nothing has to be looked at.
      fastest = std::abs(m.v.y()) + turning + gusting;
      double gap = std::numeric_limits<double>::infinity();
      for (const LeafGround& ground : setup_.grounds) gap = std::min(gap, m.x.y() - radius - ground.height);
      if (!floats(m)) gap = std::min(gap, gap_to_water(model, m, slice, done));
      const double careful = k_near_way / (time * (turning + 0.3 * (fastest - turning)) + 1e-12);
      share = floats(m) ? k_float_share : 0;
      share = std::max(
          {share, careful, gap / (time * (fastest + time * setup_.gravity.norm()) + 1e-12), 1.0 / k_near_steps});
    } else {
      share = 1 / std::clamp(std::ceil((time * fastest + way) / k_near_way), 2.0, static_cast<double>(k_near_steps));
    }
    share = std::min(share, 1 - done);
    const double to = done + share > 1 - 1e-9 ? 1 : done + share;
    ContactStep step;
    step.slice = slice;
    step.from = done, step.to = to;
    step.time = (to - done) * time;
    step.margin = model.margin;
    step.reach = model.margin + k_touch + step.time * (fastest + 0.2) + 1.2 * (to - done) * way;
    step.touch = model.margin + k_touch;
    step.velocity = m.v;
    step.spin = m.spin;
    step.bending = bending;
    PlateAir here = air;
    here.velocity += done * time * air.change;
    steps += near_step(leaf, step, here, m, s, touch);
    done = to;
  }
  return steps;
}

LeavesSolver::Tally LeavesSolver::advance_leaf(const Frame& frame, std::size_t leaf, Moving& m, double& rest,
                                               double& asleep) const {
  thread_local ContactScratch scratch;
  const Model& model = leaves_[leaf];
  const Moving before = m;
  Tally out;
  Touch touch;
  touch.impulses = &out.impulses;
  int steps = 0;
  for (int slice = 0; slice < LeafBodies::k_slices; ++slice)
    steps += advance_slice(frame, leaf, slice, m, scratch, touch);
  if (!m.x.allFinite() || !m.v.allFinite() || !m.spin.allFinite() || !m.q.coeffs().allFinite() || !m.bent.allFinite() ||
      !m.bending.allFinite()) {
    m = {before.x, Vec3::Zero(), Vec3::Zero(), before.q, Modes::Zero(), Modes::Zero(), before.afloat};
    out.finite = false;
  }
  const double frame_time = frame.t1 - frame.t0, slice_time = frame_time / LeafBodies::k_slices;
  constexpr int last = LeafBodies::k_slices - 1;
  place_leaf(model, m, scratch.rim);
  LeafVerdict verdict = judge_leaf(bodies_, setup_.grounds, model.shape, scratch.rim, m.x, last, slice_time);
  if (!verdict.ok()) {
    const Vec3 velocity = verdict.velocity;
    bring_out(bodies_, setup_.grounds, model.shape, scratch.rim, m.x, last, slice_time, model.margin, verdict);
    m.v = velocity;
    m.spin.setZero(), m.bending.setZero();
    out.brought_out = 1;
    // As the caches will have it, from the moved centre.
    place_leaf(model, m, scratch.rim);
    verdict = judge_leaf(bodies_, setup_.grounds, model.shape, scratch.rim, m.x, last, slice_time);
  }
  out.crossings = verdict.crossings;
  out.inside = verdict.inside;
  out.deepest = std::max(verdict.below_ground, verdict.inside ? verdict.depth : 0.0);
  out.steps = out.longest = steps;

  const double radius = model.shape.radius;
  const double speed = m.v.norm() + (m.spin.norm() + m.bending.cwiseAbs().sum()) * radius;
  const double went =
      (m.x - before.x).norm() + (m.q.angularDistance(before.q) + (m.bent - before.bent).cwiseAbs().sum()) * radius;
  const bool still = touch.lies && !touch.moves && speed < k_sleep_speed && went < k_sleep_speed * frame_time;
  rest = still ? rest + frame_time : 0;
  if (setup_.may_sleep && rest >= k_sleep_after) {
    const double holds = lift_off_speed(setup_.prototypes[at(setup_.leaves[leaf].prototype)], model.mass_factor,
                                        lowest_friction(setup_), setup_.gravity.norm(), setup_.air_density);
    const bool calm = !frame.has_wind || frame.air[LeafBodies::k_slices]->velocity(m.x).norm() < k_sleep_wind * holds;
    if (calm) {
      m.v.setZero(), m.spin.setZero(), m.bending.setZero();
      asleep = 1, rest = 0;
    }
  }
  out.awake = asleep == 0;
  out.afloat = floats(m);
  out.fastest = m.v.norm();
  const Vec3 body_spin = m.q.conjugate() * m.spin;
  out.energy =
      0.5 * model.plate.mass * m.v.squaredNorm() + 0.5 * body_spin.dot(model.plate.inertia.cwiseProduct(body_spin));
  if (model.bending) out.energy += 0.5 * m.bending.dot(model.bending->mass * m.bending);
  return out;
}

}  // namespace ft::inline solvers

// See leaf_contact.h: the impulses of one leaf's contacts.
#include <algorithm>
#include <cmath>

#include "solvers/leaves/leaf_contact.h"

namespace ft::inline solvers {
namespace {

constexpr int k_sweeps = 16;
/// A sweep that changes no velocity by more than this is the last [m/s].
constexpr double k_settled = 2e-5;
/// A leaf that is too near is put right no faster than the body comes and so much [m/s].
constexpr double k_put_right = 2.0;

void place_bends(std::span<const LeafContact> contacts, ContactScratch& s) {
  s.bends.assign(2 * contacts.size(), Vec3::Zero());
  for (std::size_t c = 0; c < contacts.size(); ++c)
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (std::size_t mode = 0; mode < 2; ++mode)
        s.bends[2 * c + mode] +=
            contacts[c].weights[static_cast<int>(corner)] * s.directions[2 * at(contacts[c].vertices[corner]) + mode];
}

}  // namespace

LeafVelocity solve_contacts(std::span<const LeafContact> contacts, const LeafMobility& leaf, double time, double margin,
                            const LeafVelocity& wanted, ContactScratch& s, LeafVelocity& kept, bool& pushed) {
  const std::size_t n = contacts.size();
  pushed = false;
  const double inverse_mass = leaf.inverse_mass;
  const Mat3& inverse_inertia = leaf.inverse_inertia;
  const bool bends = leaf.inverse_modes != nullptr;
  if (bends) place_bends(contacts, s);
  // With the modes: how a contact's place moves, what of an impulse bends, and what that moves.
  const auto bending_of = [&](std::size_t c, const LeafVelocity& v) -> Vec3 {
    return s.bends[2 * c] * v.bending[0] + s.bends[2 * c + 1] * v.bending[1];
  };
  const auto modes_along = [&](std::size_t c, const Vec3& d) {
    return Modes(s.bends[2 * c].dot(d), s.bends[2 * c + 1].dot(d));
  };
  const auto yields = [&](std::size_t c, const Vec3& d) {
    if (!bends) return 0.0;
    const Modes g = modes_along(c, d);
    return g.dot(*leaf.inverse_modes * g);
  };
  bool all_move_off = true;
  for (std::size_t c = 0; c < n && all_move_off; ++c) {
    const LeafContact& k = contacts[c];
    Vec3 speed = wanted.linear + wanted.angular.cross(k.arm);
    if (bends) speed += bending_of(c, wanted);
    all_move_off = speed.dot(k.normal) * time >= margin - k.gap;
  }
  if (all_move_off) return kept = wanted;
  double farthest = 0;
  for (const LeafContact& k : contacts) farthest = std::max(farthest, k.arm.norm());
  s.turn.resize(2 * n);  // of each contact: what a unit impulse along its normal turns, and by how much
  s.share.resize(n);     // inverse of the effective mass: along the normal, and across it at most
  for (std::size_t c = 0; c < n; ++c) {
    const LeafContact& k = contacts[c];
    const Vec3 turn = k.arm.cross(k.normal);
    const double normal = inverse_mass + turn.dot(inverse_inertia * turn) + yields(c, k.normal);
    // Across: the largest that any direction can have, so that the step never overshoots.
    const Vec3 t1 = k.normal.unitOrthogonal(), t2 = k.normal.cross(t1);
    const Vec3 r1 = k.arm.cross(t1), r2 = k.arm.cross(t2);
    const double across =
        inverse_mass + r1.dot(inverse_inertia * r1) + r2.dot(inverse_inertia * r2) + yields(c, t1) + yields(c, t2);
    s.share[c] = Vec3(1 / normal, 1 / across, 0);
    s.turn[2 * c] = turn, s.turn[2 * c + 1] = inverse_inertia * turn;
  }
  const auto solve = [&](bool for_way) {
    LeafVelocity v = wanted;
    if (for_way) {
      s.impulse.assign(n, Vec3::Zero());
    } else {  // from those of the way, which are nearly the same
      for (std::size_t c = 0; c < n; ++c) {
        v.linear += inverse_mass * s.impulse[c];
        v.angular += inverse_inertia * contacts[c].arm.cross(s.impulse[c]);
        if (bends) v.bending += *leaf.inverse_modes * modes_along(c, s.impulse[c]);
      }
    }
    for (int sweep = 0; sweep < k_sweeps; ++sweep) {
      const LeafVelocity before_sweep = v;
      for (std::size_t c = 0; c < n; ++c) {
        const LeafContact& k = contacts[c];
        const double approach = k.velocity.dot(k.normal), want = (margin - k.gap) / time;
        // Of the way: it may use up the gap. Of what is kept: the body's own velocity is enough.
        const double least = for_way ? std::min(want, std::max(approach, 0.0) + k_put_right) : std::min(want, approach);
        double closing = v.linear.dot(k.normal) + v.angular.dot(s.turn[2 * c]);
        if (bends) closing += bending_of(c, v).dot(k.normal);
        const double before = s.impulse[c].dot(k.normal);
        const double now = std::max(0.0, before + s.share[c][0] * (least - closing));
        const auto apply = [&](const Vec3& impulse) {
          v.linear += inverse_mass * impulse;
          v.angular += inverse_inertia * k.arm.cross(impulse);
          if (bends) v.bending += *leaf.inverse_modes * modes_along(c, impulse);
        };
        if (now == 0 && before == 0) continue;  // then it has no friction either
        v.linear += inverse_mass * (now - before) * k.normal;
        v.angular += (now - before) * s.turn[2 * c + 1];
        if (bends) v.bending += *leaf.inverse_modes * modes_along(c, (now - before) * k.normal);
        // Friction, across the normal.
        Vec3 slip_all = v.linear + v.angular.cross(k.arm) - k.velocity;
        if (bends) slip_all += bending_of(c, v);
        const Vec3 slip = slip_all - slip_all.dot(k.normal) * k.normal;
        const Vec3 old = s.impulse[c] - before * k.normal;
        Vec3 friction = old - s.share[c][1] * slip;
        const double most = k.friction * now, size = friction.norm();
        if (size > most) friction *= size > 0 ? most / size : 0.0;
        apply(friction - old);
        s.impulse[c] = now * k.normal + friction;
      }
      const double turn = (v.angular - before_sweep.angular).norm() * farthest;
      const double bent = bends ? (v.bending - before_sweep.bending).norm() * farthest : 0.0;
      if ((v.linear - before_sweep.linear).norm() + turn + bent < k_settled) break;
    }
    for (const Vec3& i : s.impulse) pushed = pushed || i.squaredNorm() > 0;
    return v;
  };
  const LeafVelocity way = solve(true);
  kept = pushed ? solve(false) : way;
  return way;
}

}  // namespace ft::inline solvers

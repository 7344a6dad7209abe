// The paper's ball and net, for tests of the couplings.
#pragma once

#include <algorithm>

#include "baker/core/equimomental.h"
#include "baker/core/shapes.h"
#include "solvers/cords/generators.h"
#include "solvers/lockstep/lockstep_solver.h"

namespace ft::test {

inline constexpr double k_ball_mass = 0.68, k_ball_radius = 0.121, k_net_mass = 0.03;

inline CordSystem basketball_net() {
  CordSystem out;
  out.name = "net";
  out.graph = diamond_net({});
  out.mass = k_net_mass;
  out.bend = 2e-5;
  out.hold_stiffness = 2500;
  return out;
}

/// Of constant spin, and in ballistic flight from time 0 on; it stands before.
inline RigidProp flying_ball(const Vec3& place, const Vec3& velocity, const Vec3& spin, bool two_way) {
  RigidProp out;
  out.name = "ball";
  const TriangleSurface surface = sphere_surface(k_ball_radius, 3);
  out.surface = surface.positions;
  out.triangles = surface.triangles;
  out.mass = {k_ball_mass, 2.0 / 3 * k_ball_mass * k_ball_radius * k_ball_radius * Mat3::Identity()};
  out.two_way = two_way;
  out.release = 0;
  out.track = [=](double t) {
    RigidMotion m;
    m.pose.position = place;
    if (t < 0) return m;
    const Vec3 gravity(0, -k_gravity, 0);
    m.pose.position += t * velocity + 0.5 * t * t * gravity;
    if (spin.norm() > 0) m.pose.rotation = Quat(Eigen::AngleAxisd(t * spin.norm(), spin.normalized()));
    m.velocity = velocity + t * gravity;
    m.spin = spin;
    return m;
  };
  return out;
}

/// A shallow shot with topspin; the ball is at the net after 0.3 s.
inline LockstepSetup ball_and_net(bool two_way) {
  LockstepSetup setup;
  setup.cords = {basketball_net()};
  setup.prop = flying_ball(Vec3(-0.97, 0.0387, 0), Vec3(2.8, 1.742, 0), Vec3(0, 0, -10), two_way);
  setup.fps = 60;
  setup.preroll_frames = 5;
  return setup;
}

inline RigidMotion motion_of_prop(const State& state, const RigidMass& mass) {
  return equimomental(mass).motion(as_points(*state.find("x")).last<4>(), as_points(*state.find("v")).last<4>());
}

}  // namespace ft::test

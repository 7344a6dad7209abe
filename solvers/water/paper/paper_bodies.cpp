// What a step does with bodies. See paper_frame.h.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "solvers/water/paper/paper_frame.h"

namespace ft::inline solvers {

double float_rate(const FloatingHull& hull, const PaperSetup& setup) {
  const double area = facing_area(hull.body.positions, hull.body.triangles, Vec3::UnitX()) +
                      facing_area(hull.body.positions, hull.body.triangles, Vec3::UnitY()) +
                      facing_area(hull.body.positions, hull.body.triangles, Vec3::UnitZ());
  double reach = 0;
  for (const Vec3& p : hull.body.positions) reach = std::max(reach, p.squaredNorm());
  const double least = Eigen::SelfAdjointEigenSolver<Mat3>(hull.body.mass.inertia).eigenvalues()[0];
  // Of a third of its faces, which lies in the water; the arm's square is at most half its reach's, for the mean of it.
  return setup.density * setup.gravity * setup.stiffness * area / 3 *
         (1 / hull.body.mass.mass + (least > 0 ? 0.5 * reach / least : 0));
}

void PaperFrame::add_panels(const DrivenNear& body, Wrench& on) const {
  const PipeWater& w = s_.water;
  for (const Triangle& t : body.triangles) {
    const Vec3 &a = body.places[at(t[0])], &b = body.places[at(t[1])], &c = body.places[at(t[2])];
    const Vec3 middle = (a + b + c) / 3;
    const double x = std::floor((middle.x() - setup_.origin.x()) / w.cell),
                 z = std::floor((middle.z() - setup_.origin.y()) / w.cell);
    if (!(x >= 0 && z >= 0 && x < w.nx && z < w.nz)) continue;
    const std::size_t cell = w.of(static_cast<int>(x), static_cast<int>(z));
    if (!(w.depth[cell] > 0 && middle.y() < w.head[cell] && middle.y() > w.bed[cell])) continue;
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    const double size = area.norm();
    if (!(size > 0)) continue;
    const Vec2 u = w.velocity(cell);
    Vec3 velocity = Vec3(-u.x(), 0, -u.y());
    for (const int v : t) velocity += (body.to[at(v)] - body.from[at(v)]) / (3 * frame_time_);
    const double ahead = velocity.dot(area) / size;
    if (ahead > 0) on.add(middle, -0.5 * setup_.density * setup_.driven_drag * ahead * ahead * area);
  }
}

void PaperFrame::push_driven(double dt) {
  if (s_.driven.empty()) return;
  std::vector<Wrench> on(s_.driven.size() + hulls_.size());
  s_.under.forces(s_.water.head, setup_.density * setup_.gravity, nullptr, -1, on);
  for (std::size_t b = 0; b < s_.driven.size(); ++b) {
    if (setup_.driven_drag > 0 && !s_.under.rectangle(b).empty()) add_panels(s_.driven[b], on[b]);
    if (on[b].force.isZero(0)) continue;
    on_driven_[b].mean += dt * on[b];
    on_driven_[b].peak = std::max(on_driven_[b].peak, on[b].force.norm());
    on_driven_[b].wet_share += dt;
  }
}

Vec3 PaperFrame::water_velocity(std::size_t body) const {
  const UnderBodies::Rectangle r = s_.under.rectangle(body);
  double water = 0;
  Vec2 sum = Vec2::Zero();
  for (int k = r.k0; k < r.k1; ++k)
    for (int i = r.i0; i < r.i1; ++i) {
      const std::size_t c = s_.water.of(i, k);
      water += s_.water.depth[c];
      sum += s_.water.depth[c] * s_.water.velocity(c);
    }
  return water > 0 ? Vec3(sum.x() / water, 0, sum.y() / water) : Vec3(Vec3::Zero());
}

void PaperFrame::move_floats(double dt) {
  const PipeWater& w = s_.water;
  const double weight = setup_.density * setup_.gravity;
  // What the columns feel of a body is soft by 1/stiffness; the rest is that of still water around it.
  const double pressed = 1 - 1 / setup_.stiffness;
  const GroundCells ground{setup_.origin.x(), setup_.origin.y(), w.cell, w.nx, w.nz, w.bed, 0, at(w.nx)};
  for (std::size_t b = 0; b < hulls_.size(); ++b) {
    const std::size_t body = s_.driven.size() + b;
    RigidMotion& m = s_.floats[b].motion;
    const Vec3 about = m.pose.position;
    FloatSurroundings around;
    around.any = s_.under.level_around(static_cast<int>(body), w.head, around.level);
    Vec6 force = Vec6::Zero();
    if (around.any) {
      around.velocity = water_velocity(body);
      std::vector<Wrench> now(body + 1), still(body + 1);
      now.resize(s_.driven.size() + hulls_.size()), still.resize(now.size());
      s_.under.forces(w.head, weight, nullptr, static_cast<int>(body), now);
      s_.under.forces(w.head, weight, &around.level, static_cast<int>(body), still);
      Wrench on = hydrostatics(s_.places[b], hulls_[b].body.triangles, around.level, weight, Vec3::Zero()).wrench;
      on += pressed * now[body];
      on += -pressed * still[body];
      on = on.moved(about);
      force << on.force, on.torque;
    }
    const FloatStep free =
        prepare_float(hulls_[b], s_.floats[b], s_.places[b], around, setup_.gravity, setup_.density, dt);
    const Vec6 pushed = free.free + dt * free.mass.ldlt().solve(force);
    const Vec6 v = keep_above(ground, s_.places[b], about, free.mass, pushed, dt);
    m.velocity = v.head<3>();
    m.spin = v.tail<3>();
    m.pose = moved(m.pose, v, dt);
  }
  meet_one_another(hulls_, s_.floats);
}

}  // namespace ft::inline solvers

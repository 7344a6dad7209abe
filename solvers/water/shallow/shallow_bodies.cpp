// What a patch's step does with bodies, and what a frame reports. See shallow_frame.h.
#include <algorithm>
#include <cmath>

#include "solvers/water/shallow/shallow_frame.h"

namespace ft::inline solvers {
namespace {

/// The water that a body is in: mean velocity over the cells below its box.
Vec3 water_velocity(const Flow& f, const Box& box, double x, double z) {
  const auto cell = [&](double value, double origin, int count) {
    return static_cast<int>(std::floor(std::clamp((value - origin) / f.cell, 0.0, count - 1.0)));
  };
  double water = 0;
  Vec3 sum = Vec3::Zero();
  for (int k = cell(box.lo.z(), z, f.nz); k <= cell(box.hi.z(), z, f.nz); ++k)
    for (int i = cell(box.lo.x(), x, f.nx); i <= cell(box.hi.x(), x, f.nx); ++i) {
      const std::size_t c = f.of(i, k);
      water += f.h[c];
      sum += f.h[c] * 0.5 * Vec3(f.u[c] + f.u[c + 1], 0, f.w[c] + f.w[c + f.row]);
    }
  return water > 0 ? Vec3(sum / water) : Vec3(Vec3::Zero());
}

/// The reaction of a drag: water below the box is pushed the other way, no faster than the body goes through it.
void push_water(Flow& f, const Box& box, double x, double z, const Vec3& impulse, double density, double most) {
  const auto cell = [&](double value, double origin, int count) {
    return static_cast<int>(std::floor(std::clamp((value - origin) / f.cell, 0.0, count - 1.0)));
  };
  const int i0 = cell(box.lo.x(), x, f.nx), i1 = cell(box.hi.x(), x, f.nx), k0 = cell(box.lo.z(), z, f.nz),
            k1 = cell(box.hi.z(), z, f.nz);
  double mass = 0;
  for (int k = k0; k <= k1; ++k)
    for (int i = i0; i <= i1; ++i) mass += density * f.cell * f.cell * f.h[f.of(i, k)];
  if (!(mass > 0)) return;
  const double push_x = std::clamp(impulse.x() / mass, -most, most),
               push_z = std::clamp(impulse.z() / mass, -most, most);
  for (int k = k0; k <= k1; ++k)
    for (int i = i0; i <= i1; ++i) {
      const std::size_t c = f.of(i, k);
      if (i > 0 && f.u1[c] != 0) f.u1[c] += push_x;
      if (k > 0 && f.w1[c] != 0) f.w1[c] += push_z;
    }
}

}  // namespace

void ShallowFrame::step_bodies(double dt, double share1) {
  Flow& p = s_.patch.flow;
  const std::size_t driven = s_.driven.size();
  const double x = setup_.origin.x() + p.cell * p.x0, z = setup_.origin.y() + p.cell * p.z0;
  place_bodies(share1);
  const bool any_floats = !models_.empty();
  for (std::size_t b = 0; b < models_.size(); ++b) {
    NearBody& body = s_.bodies[driven + b];
    const RigidMotion& m = s_.floats[b].motion;
    body.posed << m.velocity, m.spin;
    body.rest_force.setZero();
  }
  std::vector<RigidPose> start;
  for (const FloatState& f : s_.floats) start.push_back(f.motion.pose);
  for (int pass = 0; pass < (any_floats ? 2 : 1); ++pass) {
    for (std::size_t b = 0; b < models_.size(); ++b) {
      NearBody& body = s_.bodies[driven + b];
      const RigidPose pose = moved(start[b], body.posed, dt);
      float_positions(models_[b], pose, s_.float_places[b]);
      body.surface = {models_[b].body.triangles, s_.float_places[b]};
      body.about = pose.position;
    }
    s_.near.find(p, s_.bodies, x, z, near_);
    for (std::size_t b = 0; b < models_.size(); ++b) {
      NearBody& body = s_.bodies[driven + b];
      FloatSurroundings water;
      water.any = s_.near.level_around(driven + b, p, water.level);
      if (pass == 0) {
        const Box box = bounds(s_.float_places[b]);
        if (water.any) water.velocity = water_velocity(p, box, x, z);
        const Vec3 through = s_.floats[b].motion.velocity - water.velocity;
        const FloatStep free =
            prepare_float(models_[b], s_.floats[b], s_.float_places[b], water, setup_.gravity, setup_.density, dt);
        body.mass = free.mass, body.free = free.free;
        if (water.any) push_water(p, box, x, z, -dt * free.drag, setup_.density, 0.5 * through.norm());
      }
      body.rest_force.setZero();
      if (!water.any) continue;
      const Hydrostatics exact = hydrostatics(s_.float_places[b], models_[b].body.triangles, water.level,
                                              setup_.density * setup_.gravity, body.about);
      body.rest_force << exact.wrench.force, exact.wrench.torque;
      body.rest_force -= s_.near.force(driven + b, body, near_, p.cell, &water.level);
    }
    if (any_floats) {
      if (pass == 0) {
        s_.u1 = p.u1, s_.w1 = p.w1, s_.qx1 = p.qx1, s_.qz1 = p.qz1;
      } else {
        p.u1 = s_.u1, p.w1 = s_.w1, p.qx1 = s_.qx1, p.qz1 = s_.qz1;
      }
    }
    s_.near.solve(p, s_.bodies, near_, dt, pass == 0);
    for (std::size_t b = 0; b < models_.size(); ++b) s_.bodies[driven + b].posed = s_.bodies[driven + b].velocity;
  }
  report_.near_cells = std::max(report_.near_cells, static_cast<int>(s_.near.cells().size()));
  const Flow& f = s_.flow;
  const GroundCells ground{setup_.origin.x(), setup_.origin.y(), f.cell, f.nx, f.nz, f.bed, f.of(0, 0), f.row};
  for (std::size_t b = 0; b < models_.size(); ++b) {
    const NearBody& body = s_.bodies[driven + b];
    RigidMotion& m = s_.floats[b].motion;
    std::vector<Vec3> places;
    float_positions(models_[b], m.pose, places);
    const Vec6 v = keep_above(ground, places, m.pose.position, body.mass, body.velocity, dt);
    m.velocity = v.head<3>();
    m.spin = v.tail<3>();
    m.pose = moved(m.pose, v, dt);
  }
  meet_one_another(models_, s_.floats);
}

void ShallowFrame::add_forces(double dt) {
  for (std::size_t b = 0; b < s_.bodies.size(); ++b) {
    const Vec6 force = s_.near.force(b, s_.bodies[b], near_, s_.flow.cell, nullptr) + s_.bodies[b].rest_force;
    impulse_[b] += dt * force;
    if (force.head<3>().norm() > peak_[b].force.norm()) peak_[b] = {force.head<3>(), force.tail<3>()};
  }
  const Flow& p = s_.patch.flow;
  for (const NearWater::Cell& cell : s_.near.cells()) {
    if (!(cell.covered >= 0.5)) continue;
    for (int side = 0; side < 4; ++side) {
      const bool along_x = side < 2, high = side % 2 == 1;
      const int other =
          s_.near.index(cell.i + (along_x ? (high ? 1 : -1) : 0), cell.k + (along_x ? 0 : (high ? 1 : -1)));
      if (other < 0 || s_.near.cells()[at(other)].covered >= 0.5) continue;
      const std::size_t face = cell.c + (high ? (along_x ? 1 : p.row) : 0);
      report_.rim_fastest = std::max(report_.rim_fastest, (high ? 1 : -1) * (along_x ? p.u1 : p.w1)[face]);
    }
  }
}

ShallowReport ShallowFrame::report() {
  const Flow& f = s_.flow;
  ShallowReport& r = report_;
  r.newton_iterations = s_.near.newton_count;
  r.linear_iterations = s_.near.linear_count;
  r.failed_solves = s_.near.failed_count;
  r.droplets = static_cast<int>(s_.droplets.size());
  for (std::size_t b = 0; b < s_.bodies.size(); ++b) {
    WaterForce force;
    force.mean = {impulse_[b].head<3>() / frame_time_, impulse_[b].tail<3>() / frame_time_};
    force.peak = peak_[b];
    (b < s_.driven.size() ? r.driven : r.floats).push_back(force);
  }
  double moving = 0, high = 0;
  for (int k = 0; k < f.nz; ++k) {
    double row_moving = 0, row_high = 0;
    for (int i = 0; i < f.nx; ++i) {
      const std::size_t c = f.of(i, k);
      const double u = f.u[c], w = f.w[c];
      if (i > 0) row_moving += 0.25 * (f.h[c] + f.h[c - 1]) * u * u;
      if (k > 0) row_moving += 0.25 * (f.h[c] + f.h[c - f.row]) * w * w;
      row_high += f.h[c] * (f.bed[c] + 0.5 * f.h[c]);
      r.lowest_depth = std::min(r.lowest_depth, f.h[c]);
    }
    moving += row_moving, high += row_high;
  }
  // Near bodies columns are not filled alike.
  const Flow& p = s_.patch.flow;
  for (const NearWater::Cell& cell : s_.near.cells())
    if (cell.begin != cell.end) high += s_.near.potential(p, cell) - p.h[cell.c] * (p.bed[cell.c] + 0.5 * p.h[cell.c]);
  const double area = f.cell * f.cell;
  r.kinetic = setup_.density * area * moving;
  r.potential = setup_.density * setup_.gravity * area * high;
  r.finite = std::isfinite(moving) && std::isfinite(high);
  for (std::size_t b = 0; b < models_.size(); ++b) {
    const RigidMotion& m = s_.floats[b].motion;
    const RigidMass& mass = models_[b].body.mass;
    const Mat3 turn = m.pose.rotation.toRotationMatrix();
    r.floats_energy += 0.5 * (mass.mass + s_.floats[b].added_mass) * m.velocity.squaredNorm() +
                       0.5 * m.spin.dot(turn * mass.inertia * turn.transpose() * m.spin) +
                       mass.mass * setup_.gravity * m.pose.position.y();
  }
  return r;
}

}  // namespace ft::inline solvers

#include "solvers/leaves/leaf_bending.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

/// Of critical damping: dry leaves rattle, and do not ring. Guessed [1].
constexpr double k_damping_ratio = 0.1;
/// Steps of free flight, by the fastest mode's radian [1].
constexpr double k_step = 0.25;
constexpr int k_most_steps = 64;

/// A vertex of the plate, folded and curled, with its centre of mass where the fold and curl leave it.
Vec3 bent_place(const LeafBending& model, const Vec3& p, const Modes& bent) {
  const double side = p.z() < 0 ? -1 : 1, sine = std::sin(bent[1]), cosine = std::cos(bent[1]);
  const double across = std::abs(p.z()), height = p.y() - model.rib_height;
  const double y = height * cosine + across * sine, z = side * (across * cosine - height * sine);
  const double curvature = bent[0] / model.half_length, angle = curvature * p.x();
  // sin(a)/a and (1 - cos(a))/a, where a may be 0.
  const double along = std::abs(angle) < 1e-4 ? 1 - angle * angle / 6 : std::sin(angle) / angle;
  const double up = std::abs(angle) < 1e-4 ? 0.5 * angle : (1 - std::cos(angle)) / angle;
  return {p.x() * along - y * std::sin(angle), model.rib_height + p.x() * up + y * std::cos(angle), z};
}

}  // namespace

LeafBending bending_of(const LeafShape& shape, const PlateModel& plate, double bending) {
  CHECK(bending > 0);
  LeafBending out;
  out.area_share.assign(shape.positions.size(), 0);
  double sum = 0;
  for (const Triangle& t : shape.triangles) {
    const double area = triangle_area(shape.positions[at(t[0])], shape.positions[at(t[1])], shape.positions[at(t[2])]);
    sum += area;
    for (const int v : t) out.area_share[at(v)] += area / 3;
  }
  for (double& share : out.area_share) share /= sum;
  // The rib's height: where a line through y over |z| meets z = 0.
  double z = 0, y = 0, zz = 0, yz = 0;
  Box box;
  for (std::size_t i = 0; i < shape.positions.size(); ++i) {
    const Vec3& p = shape.positions[i];
    const double w = out.area_share[i], across = std::abs(p.z());
    z += w * across, y += w * p.y(), zz += w * across * across, yz += w * across * p.y();
    box.include(p);
  }
  const double spread = zz - z * z;
  out.rib_height = spread > 1e-12 * zz ? y - z * (yz - z * y) / spread : y;
  out.half_length = std::max(box.hi.x(), -box.lo.x());
  out.half_width = std::max(box.hi.z(), -box.lo.z());
  out.own_mass = plate.mass;
  std::vector<Vec3> directions;
  bend_directions(out, shape, Modes::Zero(), directions);
  // Air that goes along with a strip as wide as the leaf is in the mean: rho pi c / 4 by area.
  const double whole = plate.mass + plate.air_density * std::numbers::pi / 2 * plate.half_chord[0] * plate.area;
  for (std::size_t i = 0; i < shape.positions.size(); ++i)
    for (std::size_t a = 0; a < 2; ++a)
      for (std::size_t b = 0; b < 2; ++b)
        out.mass(static_cast<int>(a), static_cast<int>(b)) +=
            whole * out.area_share[i] * directions[2 * i + a].dot(directions[2 * i + b]);
  const Eigen::Matrix2d inverse_mass = out.mass.inverse();
  out.stiffness =
      bending * plate.area * Modes(1 / (out.half_length * out.half_length), 1 / (out.half_width * out.half_width));
  for (int k = 0; k < 2; ++k) {
    const double frequency = std::sqrt(out.stiffness[k] * inverse_mass(k, k));
    out.damping[k] = 2 * k_damping_ratio * out.stiffness[k] / frequency;
    out.fastest = std::max(out.fastest, frequency);
  }
  return out;
}

void bend(const LeafBending& model, const LeafShape& shape, const Modes& bent, std::vector<Vec3>& out) {
  out.resize(shape.positions.size());
  Vec3 centre = Vec3::Zero();
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = bent_place(model, shape.positions[i], bent);
    centre += model.area_share[i] * out[i];
  }
  for (Vec3& p : out) p -= centre;
}

void bend_directions(const LeafBending& model, const LeafShape& shape, const Modes& bent, std::vector<Vec3>& out) {
  constexpr double k_angle = 1e-4;
  out.resize(2 * shape.positions.size());
  for (int k = 0; k < 2; ++k) {
    Vec3 centre = Vec3::Zero();
    for (std::size_t i = 0; i < shape.positions.size(); ++i) {
      const Modes change = k_angle * Modes::Unit(k);
      Vec3& d = out[2 * i + at(k)];
      d = (bent_place(model, shape.positions[i], bent + change) -
           bent_place(model, shape.positions[i], bent - change)) /
          (2 * k_angle);
      centre += model.area_share[i] * d;
    }
    for (std::size_t i = 0; i < shape.positions.size(); ++i) out[2 * i + at(k)] -= centre;
  }
}

BendingLoad bending_load(const LeafBending& model, const LeafShape& shape, const PlateModel& plate,
                         std::span<const Vec3> places, std::span<const Vec3> directions, const Vec3& air,
                         const Vec3& spin) {
  BendingLoad out;
  for (const Triangle& t : shape.triangles) {
    const Vec3 &a = places[at(t[0])], &b = places[at(t[1])], &c = places[at(t[2])];
    const Vec3 cross = (b - a).cross(c - a);
    const double twice_area = cross.norm();
    if (!(twice_area > 0)) continue;
    const Vec3 normal = cross / twice_area, middle = (a + b + c) / 3;
    const Vec3 wind = air - spin.cross(middle);
    // Of the pressure across a plate the part along its normal: 1/2 rho C |w| (w . n).
    const double by_speed = 0.5 * plate.air_density * plate.law.face_on() * 0.5 * twice_area * wind.norm();
    Modes along;
    for (int k = 0; k < 2; ++k)
      along[k] = normal.dot(directions[2 * at(t[0]) + at(k)] + directions[2 * at(t[1]) + at(k)] +
                            directions[2 * at(t[2]) + at(k)]) /
                 3;
    out.force += by_speed * wind.dot(normal) * along;
    out.damping += by_speed * along * along.transpose();
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3 outward = -spin.cross(spin.cross(places[i]));
    for (int k = 0; k < 2; ++k)
      out.force[k] += model.own_mass * model.area_share[i] * outward.dot(directions[2 * i + at(k)]);
  }
  return out;
}

BendingStep step_bending(const LeafBending& model, const BendingLoad& load, double time, double implicit,
                         const Modes& bent, const Modes& speed) {
  const double h = implicit * time;
  const Eigen::Matrix2d stiffness = model.stiffness.asDiagonal();
  const Eigen::Matrix2d damping = load.damping + Eigen::Matrix2d(model.damping.asDiagonal());
  BendingStep out;
  out.mobility = (model.mass + h * damping + h * h * stiffness).inverse();
  out.speed = speed + out.mobility * (time * (load.force - stiffness * (bent + h * speed) - damping * speed));
  return out;
}

void bend_by(const Modes& change, Modes& bent, Modes& speed) {
  bent += change;
  for (int k = 0; k < 2; ++k) {
    if (std::abs(bent[k]) <= k_most_bent[k]) continue;
    bent[k] = std::copysign(k_most_bent[k], bent[k]);
    if (bent[k] * speed[k] > 0) speed[k] = 0;
  }
}

void advance_bending(const LeafBending& model, const LeafShape& shape, const PlateModel& plate, const Vec3& air,
                     const Vec3& spin, double time, Modes& bent, Modes& speed) {
  thread_local std::vector<Vec3> places, directions;
  const int steps = std::clamp(static_cast<int>(std::ceil(time * model.fastest / k_step)), 1, k_most_steps);
  const double h = time / steps;
  for (int k = 0; k < steps; ++k) {
    bend(model, shape, bent, places);
    bend_directions(model, shape, bent, directions);
    const BendingLoad load = bending_load(model, shape, plate, places, directions, air, spin);
    const Modes before = speed;
    speed = step_bending(model, load, h, 0.5, bent, speed).speed;
    bend_by(0.5 * h * (before + speed), bent, speed);
  }
}

}  // namespace ft::inline solvers

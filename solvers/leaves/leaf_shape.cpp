// See leaf_shape.h and leaves_setup.h.
#include "solvers/leaves/leaf_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/check.h"
#include "baker/core/placed_instances.h"

namespace ft::inline solvers {

LeafPrototype almond_leaf(std::string name, double length, double width, double fold, int stations) {
  CHECK(stations >= 2 && stations <= 12);
  LeafPrototype out;
  out.name = std::move(name);
  out.fold = fold;
  out.positions.push_back(Vec3(-0.5 * length, 0, 0));
  const double rise = std::sin(fold), run = std::cos(fold);
  for (int k = 1; k <= stations; ++k) {
    const double t = static_cast<double>(k) / (stations + 1);
    const double half = 0.5 * width * std::sin(std::numbers::pi * t);
    const double x = length * (t - 0.5);
    out.positions.push_back(Vec3(x, 0, 0));
    out.positions.push_back(Vec3(x, half * rise, half * run));
    out.positions.push_back(Vec3(x, half * rise, -half * run));
  }
  out.positions.push_back(Vec3(0.5 * length, 0, 0));
  const int tip = 3 * stations + 1;
  const auto rib = [&](int k) { return k == 0 ? 0 : k > stations ? tip : 3 * k - 2; };
  for (const int side : {1, 2}) {
    const auto rim = [&](int k) { return 3 * k - 2 + side; };
    const auto add = [&](int a, int b, int c) {
      out.triangles.push_back(side == 1 ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    add(rib(0), rim(1), rib(1));
    for (int k = 1; k < stations; ++k) {
      add(rib(k), rim(k), rim(k + 1));
      add(rib(k), rim(k + 1), rib(k + 1));
    }
    add(rib(stations), rim(stations), rib(stations + 1));
  }
  return out;
}

LeafShape shape_of(const LeafPrototype& prototype) {
  LeafShape out;
  out.positions = prototype.positions;
  out.triangles = prototype.triangles;
  out.edges = unique_edges(out.triangles);
  Vec3 centre = Vec3::Zero();
  for (const Triangle& t : out.triangles) {
    const Vec3 &a = out.positions[at(t[0])], &b = out.positions[at(t[1])], &c = out.positions[at(t[2])];
    const double area = triangle_area(a, b, c);
    out.area += area;
    centre += area / 3 * (a + b + c);
  }
  CHECK(out.area > 0);
  centre /= out.area;
  Box box;
  for (Vec3& p : out.positions) {
    p -= centre;
    box.include(p);
    out.radius = std::max(out.radius, p.norm());
  }
  double arm = 0;
  for (const Triangle& t : out.triangles) {
    const Vec3 &a = out.positions[at(t[0])], &b = out.positions[at(t[1])], &c = out.positions[at(t[2])];
    const double area = triangle_area(a, b, c);
    // Exact for quadratics: the middles of the three sides.
    for (const Vec3& p : {Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)), Vec3(0.5 * (c + a))}) {
      const Vec3 squares = p.cwiseProduct(p);
      out.inertia += area / 3 * (Vec3::Constant(squares.sum()) - squares);
    }
    arm += area * std::abs((a + b + c).z() / 3);
  }
  out.panel_arm = arm / out.area;
  const Vec3 size = box.hi - box.lo;
  out.half_chord[0] = out.area / (2 * size.x());
  out.half_chord[2] = out.area / (2 * size.z());
  out.half_chord[1] = 0.5 * (out.half_chord[0] + out.half_chord[2]);
  return out;
}

SystemShape instances_of(const LeavesSetup& setup) {
  SystemShape out;
  out.name = setup.name;
  out.content.shape = OutputShape::k_instances;
  out.content.angular_velocities = true;
  out.content.scales = true;
  for (const LeafPrototype& prototype : setup.prototypes) {
    const LeafShape shape = shape_of(prototype);
    out.instances.prototype_names.push_back(prototype.name);
    out.prototypes.push_back(make_triangle_mesh(prototype.name, shape.positions, shape.triangles));
  }
  for (const Leaf& leaf : setup.leaves) {
    out.instances.ids.push_back(static_cast<std::uint64_t>(leaf.id));
    out.instances.prototypes.push_back(leaf.prototype);
  }
  return out;
}

Mesh mesh_of(const LeavesSetup& setup) {
  const SystemShape shape = instances_of(setup);
  FrameData start;
  for (const Leaf& leaf : setup.leaves) {
    start.positions.push_back(leaf.position.cast<float>());
    start.orientations.push_back(leaf.orientation.cast<float>().normalized());
    start.scales.push_back(Vec3f::Constant(static_cast<float>(leaf.scale)));
  }
  return make_triangle_mesh(setup.name, placed(shape.prototypes, shape.instances.prototypes, start),
                            instances_as_mesh(shape.prototypes, shape.instances.prototypes).triangles);
}

PlateModel plate_of(const LeafPrototype& prototype, const LeafShape& shape, double scale, double mass_factor,
                    double air_density) {
  PlateModel out;
  const double s2 = scale * scale, density = prototype.mass_per_area * mass_factor;
  out.area = s2 * shape.area;
  out.mass = density * out.area;
  out.inertia = density * s2 * s2 * shape.inertia;
  out.half_chord = scale * shape.half_chord;
  out.air_density = air_density;
  out.fold = prototype.fold;
  out.panel_arm = scale * shape.panel_arm;
  out.law = prototype.law;
  add_air(out, !prototype.strip);
  return out;
}

}  // namespace ft::inline solvers

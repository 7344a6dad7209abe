// Scenes of leaves for their tests: winds by formula, bodies that are small meshes.
#pragma once

#include <gtest/gtest.h>

#include "baker/core/placed_instances.h"
#include "baker/core/random.h"
#include "baker/core/shapes.h"
#include "solvers/leaves/leaves_solver.h"
#include "tests/support/scripted_body.h"

namespace ft::test {

/// A wind that is a function of place and time.
class FormulaWind final : public WindField {
 public:
  using Formula = std::function<Vec3(const Vec3& place, double time)>;
  FormulaWind(Formula formula, double fastest) : WindField({}), formula_(std::move(formula)), fastest_(fastest) {}
  std::unique_ptr<AirNow> at_time(double time) const override {
    struct Now final : AirNow {
      Formula formula;
      double time;
      Now(Formula f, double t) : formula(std::move(f)), time(t) {}
      Vec3 velocity(const Vec3& place) const override { return formula(place, time); }
    };
    return std::make_unique<Now>(formula_, time);
  }
  double fastest() const override { return fastest_; }

 private:
  Formula formula_;
  double fastest_;
};

inline std::shared_ptr<const Wind> wind_of(FormulaWind::Formula formula, double fastest) {
  auto wind = std::make_shared<Wind>();
  wind->add(std::make_unique<FormulaWind>(std::move(formula), fastest));
  return wind;
}

/// About the y axis [m2/s, m].
inline std::shared_ptr<const Wind> rankine(double circulation, double core) {
  return wind_of(
      [=](const Vec3& p, double) {
        const double r2 = p.x() * p.x() + p.z() * p.z();
        const double angular = circulation / (2 * std::numbers::pi * std::max(r2, core * core));
        return Vec3(angular * p.z(), 0, -angular * p.x());
      },
      circulation / (2 * std::numbers::pi * core));
}

inline LeafObstacle obstacle_of(std::string name, const TriangleSurface& shape, const Vec3& place,
                                std::function<Vec3(double)> way = {}) {
  Surface surface;
  surface.triangles = shape.triangles;
  surface.part_of_vertex.assign(shape.positions.size(), 0);
  std::vector<Vec3> bind = shape.positions;
  for (Vec3& p : bind) p += place;
  LeafObstacle out;
  out.name = std::move(name);
  out.fixed = !way;
  out.trajectory = std::make_shared<ScriptedBody>(surface, bind, 0, [way](double time, std::span<Vec3> x) {
    if (way)
      for (Vec3& p : x) p += way(time);
  });
  return out;
}

/// Leaves of one shape, `spread` apart in a square from `height` on, tilted by up to `tilt` either way [m, rad].
inline LeavesSetup many_leaves(int count, double height, double spread, double tilt, double mass_per_area = 0.08) {
  LeavesSetup setup;
  setup.prototypes.push_back(almond_leaf("oak", 0.08, 0.05, 0.15));
  setup.prototypes[0].mass_per_area = mass_per_area;
  const int side = std::max(1, static_cast<int>(std::ceil(std::sqrt(count))));
  for (int i = 0; i < count; ++i) {
    const auto random = [&](std::uint64_t draw) {
      return 2 * random_uniform({7, 7, 7, static_cast<std::uint64_t>(i)}, draw) - 1;
    };
    Leaf leaf;
    leaf.id = i;
    leaf.position = Vec3((i % side - 0.5 * (side - 1)) * spread, height, (i / side - 0.5 * (side - 1)) * spread);
    leaf.orientation = Quat(Eigen::AngleAxisd(std::numbers::pi * random(0), Vec3::UnitY())) *
                       Quat(Eigen::AngleAxisd(tilt * random(1), Vec3::UnitX())) *
                       Quat(Eigen::AngleAxisd(tilt * random(2), Vec3::UnitZ()));
    setup.leaves.push_back(leaf);
  }
  return setup;
}

inline std::unique_ptr<LeavesSolver> solver_of(LeavesSetup setup) {
  auto solver = LeavesSolver::make(std::move(setup));
  EXPECT_TRUE(solver) << solver.error().text();
  return std::move(*solver);
}

inline std::vector<LeafState> leaves_of(const LeavesSolver& solver, const State& state) {
  std::vector<LeafState> out(at(solver.leaf_count()));
  solver.leaf_states(state, out);
  return out;
}

/// All leaves as one mesh, and its vertices as the caches have them.
inline PlacedInstances surface_of(const LeavesSolver& solver) {
  const SystemShape& shape = *solver.system_shape(0);
  return instances_as_mesh(shape.prototypes, shape.instances.prototypes);
}
inline std::vector<Vec3> cached_vertices(const LeavesSolver& solver, const State& state) {
  const SystemShape& shape = *solver.system_shape(0);
  FrameData frame;
  solver.system_frame(state, 0, frame);
  return placed(shape.prototypes, shape.instances.prototypes, frame);
}

}  // namespace ft::test

// Heads of hair for tests: strands combed over a ball, above a neck and shoulders.
#pragma once

#include <gtest/gtest.h>

#include "baker/core/output_frame.h"
#include "baker/core/random.h"
#include "baker/core/shapes.h"
#include "solvers/hair/hair_solver.h"
#include "tests/support/scripted_body.h"

namespace ft::test {

using Placing = std::function<Eigen::Isometry3d(double time)>;

inline std::shared_ptr<const Trajectory> rigid_body(const TriangleSurface& shape, const Vec3& place, Placing way = {}) {
  Surface surface;
  surface.triangles = shape.triangles;
  surface.part_of_vertex.assign(shape.positions.size(), 0);
  std::vector<Vec3> bind = shape.positions;
  for (Vec3& p : bind) p += place;
  return std::make_shared<ScriptedBody>(surface, bind, 0, [way](double time, std::span<Vec3> x) {
    if (!way) return;
    const Eigen::Isometry3d now = way(time);
    for (Vec3& p : x) p = now * p;
  });
}

inline constexpr double k_head = 0.1;

/// Combed from the crown down along the head, 3 mm away from it, and from its widest place straight down.
inline std::vector<Vec3> combed(double from_crown, double around, double length, int vertices) {
  std::vector<Vec3> out;
  const Vec3 side(std::cos(around), 0, std::sin(around));
  for (int i = 0; i < vertices; ++i) {
    const double s = length * i / (vertices - 1), radius = k_head + std::min(0.003, 0.3 * s);
    const double angle = from_crown + s / k_head, widest = std::numbers::pi / 2;
    if (angle < widest)
      out.push_back(radius * (std::sin(angle) * side + std::cos(angle) * Vec3::UnitY()));
    else
      out.push_back(radius * side - (angle - widest) * k_head * Vec3::UnitY());
  }
  return out;
}

/// A head that moves, on shoulders that do not.
inline HairSetup head_of_hair(int strands, double length, int vertices, Placing way = {}) {
  HairSetup setup;
  setup.preroll_frames = 0;
  for (int k = 0; k < strands; ++k) {
    const double share = (k + 0.5) / strands;
    HairStrand strand;
    strand.id = static_cast<std::uint64_t>(k);
    strand.positions = combed(std::acos(1 - 0.85 * share), 2.39996 * k, length, vertices);
    setup.strands.push_back(std::move(strand));
  }
  setup.scalp = rigid_body(sphere_surface(k_head, 4), Vec3::Zero(), way);
  setup.bodies.push_back({"head", setup.scalp});
  const TriangleSurface shoulders = capsule_surface(0.06, 0.3, 3);
  setup.bodies.push_back({"shoulders", rigid_body(shoulders, Vec3(0, -0.24, 0))});
  return setup;
}

inline std::unique_ptr<HairSolver> solver_of(HairSetup setup) {
  auto solver = HairSolver::make(std::move(setup));
  EXPECT_TRUE(solver) << solver.error().text();
  return std::move(*solver);
}

inline std::vector<Vec3f> strands_of(const HairSolver& solver, const State& state) {
  FrameData frame;
  solver.system_frame(state, 0, frame);
  return frame.positions;
}

}  // namespace ft::test

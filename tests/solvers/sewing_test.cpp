// Sewing: rest shapes from the pattern, the springs of seams, and panels that become a garment.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "baker/core/parallel.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/energies/membrane.h"
#include "solvers/energies/seams.h"
#include "tests/solvers/cloth_patches.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

std::vector<std::array<Vec2, 3>> pattern_of(std::span<const Vec3> flat, std::span<const Triangle> triangles,
                                            double mirror) {
  std::vector<std::array<Vec2, 3>> out;
  for (const Triangle& t : triangles) {
    std::array<Vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) uv[k] = Vec2(mirror * flat[at(t[k])].x(), flat[at(t[k])].y());
    out.push_back(uv);
  }
  return out;
}

TEST(Pattern, A_flat_panel_is_the_same_cloth_as_its_pattern_mirrored_or_not) {
  const auto flat = jitter(grid_points(4, 5, [](double s, double t) { return Vec3(0.1 * s, 0.12 * t, 0); }), 2e-3, 5);
  auto rest = flat;
  for (Vec3& p : rest) p.z() = 0;
  const auto triangles = grid_triangles(4, 5);
  Fabric fabric;
  fabric.stretch_warp = 900, fabric.stretch_weft = 300, fabric.shear = 80;
  const int count = static_cast<int>(rest.size());
  const ClothPiece placed[] = {{0, count, fabric}}, cut[] = {{0, count, fabric, 1.0}},
                   in_centimetres[] = {{0, count, fabric, 0.01}};
  auto uvs = pattern_of(rest, triangles, 1), mirrored = pattern_of(rest, triangles, -1), large = uvs;
  for (auto& uv : large)
    for (Vec2& p : uv) p *= 100;
  const auto x = jitter(rest, 3e-3, 9);
  const ClothTopology a = make_cloth_topology(rest, triangles, placed, uvs);
  const double expected = Membrane(a).value(x);
  ASSERT_GT(expected, 0);
  // The staged positions are of no consequence once it is cut from a pattern.
  const auto elsewhere = jitter(rest, 0.05, 1);
  for (const ClothTopology& b :
       {make_cloth_topology(elsewhere, triangles, cut, uvs), make_cloth_topology(elsewhere, triangles, cut, mirrored),
        make_cloth_topology(elsewhere, triangles, in_centimetres, large)}) {
    EXPECT_NEAR(Membrane(b).value(x), expected, 1e-9 * expected);
    for (std::size_t i = 0; i < a.mass.size(); ++i) EXPECT_NEAR(b.mass[i], a.mass[i], 1e-12 * a.mass[i]);
    for (const Hinge& hinge : b.hinges) EXPECT_EQ(hinge.rest_angle, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = rest[at(triangles[7][(k + 2) % 3])] - rest[at(triangles[7][(k + 1) % 3])];
      EXPECT_NEAR(rest_length(b, 7, k), edge.norm(), 1e-12);
    }
  }
}

ClothTopology one_seam(double gap) {
  ClothTopology topology;
  topology.vertex_count = 3;
  topology.rest = {Vec3(gap, 0, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  SeamPoint p;
  p.vertex = 0, p.edge = {1, 2}, p.place = 0.5;
  p.start_gap = gap, p.opens_at = -2, p.closed_at = -1;
  p.stiffness = 1000, p.pull = 0.2, p.hold = 5;
  topology.seams.push_back(p);
  return topology;
}

Vec3 force_at(const ClothTopology& topology, double time) {
  Seams seams(topology);
  StepContext context;
  context.time = time;
  context.x_t0 = topology.rest;
  seams.begin_step(context);
  std::vector<Vec3> g(3, Vec3::Zero());
  seams.add_gradient(topology.rest, g);
  EXPECT_NEAR((g[0] + g[1] + g[2]).norm(), 0, 1e-12);
  return -g[0];
}

TEST(Seams, A_seam_closes_evenly_with_a_bounded_force_and_then_holds) {
  const ClothTopology topology = one_seam(0.3);
  EXPECT_EQ(force_at(topology, -2), Vec3::Zero());                           // not yet
  EXPECT_NEAR(force_at(topology, -2 + 1e-4 / 0.3).x(), -1000 * 1e-4, 1e-9);  // 0.1 mm shorter by now
  EXPECT_NEAR(force_at(topology, -1.5).x(), -0.2, 1e-12);                    // 15 cm too long: the limit
  EXPECT_NEAR(force_at(topology, -0.5).x(), -0.5 * (0.2 + 5), 1e-12);        // closed; the limit grows
  EXPECT_NEAR(force_at(topology, 3).x(), -5, 1e-12);
  EXPECT_NEAR(force_at(one_seam(1e-4), 3).x(), -0.1, 1e-12);  // below the limit: a spring
}

/// Two square panels of 20 cm, 8 cm apart, edge to edge; the second has three cells for two of the first along the
/// seam.
ClothSetup two_panels() {
  Mesh mesh;
  mesh.name = "bib";
  std::vector<Triangle> triangles;
  const auto add = [&](int columns, int rows, double x0) {
    const int first = static_cast<int>(mesh.positions.size());
    for (const Vec3& p :
         grid_points(columns, rows, [&](double s, double t) { return Vec3(x0 + 0.2 * s, 0.5, 0.2 * t); })) {
      mesh.positions.push_back(p);
      mesh.uvs.emplace_back(p.x(), p.z());
    }
    for (Triangle t : grid_triangles(columns, rows)) {
      for (int& v : t) v += first;
      triangles.push_back(t);
    }
    return first;
  };
  add(8, 8, -0.24);
  const int second = add(8, 12, 0.04);
  Mesh joined = make_triangle_mesh("bib", mesh.positions, triangles);
  joined.uvs = mesh.uvs;
  joined.face_uvs = joined.face_vertices;
  for (int j = 0; j <= 12; ++j) {
    const double along = j * 8 / 12.0;
    const int cell = std::min(7, static_cast<int>(along));
    joined.stitches.push_back({second + 9 * j, {8 + 9 * cell, 8 + 9 * (cell + 1)}, along - cell, 0});
  }
  ClothSetup setup;
  setup.preroll_frames = 24;
  ClothGarment bib;
  bib.name = "bib";
  bib.mesh = joined;
  bib.pattern_scale = 1;
  setup.garments.push_back(std::move(bib));
  return setup;
}

double widest_seam(const Mesh& mesh, std::span<const Vec3> x) {
  double out = 0;
  for (const Stitch& s : mesh.stitches)
    out = std::max(out, (x[at(s.vertex)] - (1 - s.place) * x[at(s.edge[0])] - s.place * x[at(s.edge[1])]).norm());
  return out;
}

TEST(Sewing, Two_panels_become_one_that_falls_whole) {
  ClothSetup setup = two_panels();
  const Mesh mesh = setup.garments[0].mesh;
  auto made = make_cloth_solver(std::move(setup));
  ASSERT_TRUE(made) << made.error().text();
  State state = (*made)->initial_state();
  std::vector<Vec3> x(mesh.positions.size());
  double height = 0.5;
  for (int f = 0; f < 36; ++f) {
    const FrameReport r = (*made)->advance_frame(state);
    EXPECT_TRUE(r.finite);
    EXPECT_EQ(r.crossings_self, 0) << f;
    EXPECT_EQ(r.rewinds, 0) << f;
    EXPECT_LT(r.strain_max, 0.05) << f;
    (*made)->system_positions(state, 0, x);
    height = 0;
    for (const Vec3& p : x) height += p.y() / static_cast<double>(x.size());
    if (f < 12) {  // while it is sewn it sinks, at most at 5 cm/s, and both come half the way
      EXPECT_LT(height, 0.5) << f;
      EXPECT_GT(height, 0.5 - 0.05 * (f + 1) / 24.0 - 1e-3) << f;
    }
    if (f == 13) {
      EXPECT_LT(widest_seam(mesh, x), 1e-3);
    }
  }
  EXPECT_LT(widest_seam(mesh, x), 1e-4);
  EXPECT_LT(height, 0.4);  // then it falls
}

TEST(Sewing, Seams_that_do_not_close_are_named_once_they_should_have) {
  ClothSetup setup = two_panels();
  ClothPin nailed;
  nailed.to_world = true;
  nailed.stiffness = 1e7;
  nailed.max_pull = 1e7;
  for (int v = 0; v < setup.garments[0].mesh.vertex_count(); ++v) nailed.vertices.push_back(v);
  setup.garments[0].pins.push_back(nailed);
  auto made = make_cloth_solver(std::move(setup));
  ASSERT_TRUE(made);
  State state = (*made)->initial_state();
  for (int f = 0; f < 30; ++f) {
    const FrameReport r = (*made)->advance_frame(state);
    if (f < 12) {
      EXPECT_EQ(r.open_stitches, 0) << f;
    }
    if (f < 26) continue;
    EXPECT_EQ(r.open_stitches, 13) << f;
    EXPECT_GT(r.widest_seam, 0.05) << f;
    ASSERT_FALSE(r.incidents.empty()) << f;
    EXPECT_EQ(r.incidents[0].kind, Incident::Kind::k_open_seam);
    EXPECT_EQ(r.incidents[0].depth, r.widest_seam);
    EXPECT_EQ(r.incidents[0].system, "bib");
  }
}

TEST(Sewing, Is_the_same_when_it_is_resumed_midway_and_for_any_number_of_threads) {
  Hash128 first{};
  for (const int threads : {1, 2, 3}) {
    const ThreadLimit limit(threads);
    auto whole = make_cloth_solver(two_panels());
    ASSERT_TRUE(whole);
    State state = (*whole)->initial_state();
    for (int f = 0; f < 14; ++f) {
      if (f == 7) {  // another program goes on from what was saved
        whole = make_cloth_solver(two_panels());
        ASSERT_TRUE(whole);
      }
      (*whole)->advance_frame(state);
    }
    if (threads == 1) {
      auto straight = make_cloth_solver(two_panels());
      State other = (*straight)->initial_state();
      for (int f = 0; f < 14; ++f) (*straight)->advance_frame(other);
      EXPECT_EQ(hash(other), hash(state));
      first = hash(state);
    }
    EXPECT_EQ(hash(state), first);
  }
}

TEST(Sewing, Seams_do_not_depend_on_the_mass_of_the_cloth) {
  for (const double mass : {0.03, 1.0}) {
    ClothSetup setup = two_panels();
    setup.garments[0].fabric.mass_per_area = mass;
    const Mesh mesh = setup.garments[0].mesh;
    auto made = make_cloth_solver(std::move(setup));
    ASSERT_TRUE(made);
    State state = (*made)->initial_state();
    for (int f = 0; f < 20; ++f) (*made)->advance_frame(state);
    std::vector<Vec3> x(mesh.positions.size());
    (*made)->system_positions(state, 0, x);
    EXPECT_LT(widest_seam(mesh, x), 2e-4) << mass;
  }
}

TEST(Sewing, A_stitch_that_cannot_be_sewn_is_refused) {
  for (const Stitch& bad : {Stitch{0, {0, 1}, 0.5, 0}, Stitch{-1, {0, 1}, 0.5, 0}, Stitch{3, {0, 99999}, 0.5, 0},
                            Stitch{3, {0, 1}, std::nan(""), 0}}) {
    ClothSetup setup = two_panels();
    setup.garments[0].mesh.stitches.push_back(bad);
    EXPECT_FALSE(make_cloth_solver(std::move(setup)));
  }
}

}  // namespace
}  // namespace ft

// Garments with edges so short that nobody sees them move: what moves has none, and the given vertices ride on it.
#include "solvers/cloth/embed/riding_solver.h"

#include <gtest/gtest.h>

#include <map>

#include "baker/core/parallel.h"
#include "solvers/cloth/cloth_solver.h"
#include "solvers/cloth/embed/coarse_garment.h"
#include "solvers/cloth/embed/riders.h"
#include "tests/support/exact_crossings.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr double k_tiny = 2e-5;

/// A sheet of n x n squares over a ball at x, some of whose vertices have become spots of tiny triangles: each is a
/// ring around one.
Mesh spotted_sheet(double side, int n, double x, bool spots) {
  Mesh sheet = make_sheet(side, n, 0);
  for (Vec3& p : sheet.positions) p += Vec3(x, 0, 0);
  if (!spots) return sheet;
  std::vector<Triangle> triangles = triangulate(sheet), out;
  std::vector<Vec3> points = sheet.positions;
  std::vector<std::vector<int>> around(points.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (const int v : triangles[t]) around[at(v)].push_back(static_cast<int>(t));
  const auto on_outline = [&](std::size_t v) {
    const Vec3 p = points[v] - Vec3(x, 0, 0);
    return std::max(std::abs(p.x()), std::abs(p.z())) > 0.5 * side - 1e-6;
  };
  std::vector<char> used(triangles.size(), 0);
  for (std::size_t v = 0; v < around.size(); ++v) {
    if (v % 7 != 3 || on_outline(v) ||
        std::any_of(around[v].begin(), around[v].end(), [&](int t) { return used[at(t)]; }))
      continue;
    // Each triangle around it is cut near it; the small end is kept, and the rest is two triangles.
    std::map<int, int> near;
    const auto cut = [&](int w) {
      const auto [found, fresh] = near.try_emplace(w, static_cast<int>(points.size()));
      if (fresh) points.push_back(points[v] + k_tiny * (points[at(w)] - points[v]).normalized());
      return found->second;
    };
    for (const int t : around[v]) {
      used[at(t)] = 1;
      Triangle c = triangles[at(t)];
      while (c[0] != static_cast<int>(v)) c = {c[1], c[2], c[0]};
      const int p = cut(c[1]), q = cut(c[2]);
      out.insert(out.end(), {{c[0], p, q}, {p, c[1], c[2]}, {p, c[2], q}});
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    if (used[t] == 0) out.push_back(triangles[t]);
  return make_triangle_mesh("sheet", std::move(points), out);
}

ClothGarment garment(const std::string& name, double x, bool spots) {
  ClothGarment out;
  out.name = name;
  out.mesh = spotted_sheet(0.4, 20, x, spots);
  for (const Vec3& p : out.mesh.positions) out.maps.bend.push_back(1 + p.z());
  return out;
}

/// A ball under each of two sheets.
ClothSetup over_balls(bool first_has_spots, bool second_has_spots) {
  Surface surface;
  std::vector<Vec3> points;
  surface.parts.push_back({"balls", -1, 1.0});
  for (const double x : {0.0, 1.0}) {
    std::vector<Vec3> ball;
    std::vector<Triangle> triangles;
    make_sphere(0.12, 16, 24, ball, triangles);
    const int first = static_cast<int>(points.size());
    for (const Vec3& p : ball) points.push_back(p + Vec3(x, -0.125, 0.01));
    for (const Triangle& t : triangles) surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  surface.part_of_vertex.resize(points.size(), 0);
  ClothSetup setup;
  setup.primary = std::make_shared<ScriptedBody>(surface, points, 0.0, [](double, std::span<Vec3>) {});
  setup.preroll_frames = 0;
  setup.garments.push_back(garment("first", 0, first_has_spots));
  setup.garments.push_back(garment("second", 1, second_has_spots));
  return setup;
}

std::vector<Vec3> positions(const Solver& solver, const State& state, int system) {
  std::vector<Vec3> out(solver.system_mesh(system).positions.size());
  solver.system_positions(state, system, out);
  return out;
}

TEST(RidingSolver, Garments_without_such_edges_are_solved_as_they_are) {
  const ClothSetup setup = over_balls(false, false);
  auto none = make_riding_solver(setup, make_cloth_solver);
  ASSERT_TRUE(none);
  EXPECT_EQ(*none, nullptr);
  ClothSetup keeps = setup;
  keeps.keep_short_edges = true;
  auto solver = make_cloth_solver(setup), same = make_cloth_solver(keeps);
  State a = (*solver)->initial_state(), b = (*same)->initial_state();
  (*solver)->advance_frame(a);
  (*same)->advance_frame(b);
  EXPECT_EQ(hash(a), hash(b));
}

TEST(RidingSolver, What_moves_has_one_vertex_for_each_spot_and_the_area_of_the_garment) {
  const ClothGarment given = garment("g", 0, true);
  const auto moves = without_short_edges(given);
  ASSERT_TRUE(moves);
  EXPECT_EQ(moves->garment.mesh.positions.size(), 21u * 21u);
  EXPECT_GT(given.mesh.positions.size(), 21u * 21u + 60);
  EXPECT_EQ(moves->garment.maps.bend.size(), moves->garment.mesh.positions.size());
  const auto area = [](const Mesh& mesh) {
    double sum = 0;
    for (const Triangle& t : triangulate(mesh))
      sum += triangle_area(mesh.positions[at(t[0])], mesh.positions[at(t[1])], mesh.positions[at(t[2])]);
    return sum;
  };
  EXPECT_NEAR(area(moves->garment.mesh), area(given.mesh), 1e-12);
}

TEST(RidingSolver, All_vertices_start_where_they_are_given_and_nothing_crosses_later) {
  const ClothSetup setup = over_balls(true, false);
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  for (int s = 0; s < 2; ++s) {
    const auto& given = setup.garments[at(s)].mesh.positions;
    const std::vector<Vec3> x = positions(**solver, state, s);
    ASSERT_EQ(x.size(), given.size());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_LT((x[i] - given[i]).norm(), 1e-15) << i;
  }
  const std::vector<Triangle> triangles = triangulate(setup.garments[0].mesh);
  const RestEdges rest = rest_edges(setup.garments[0].mesh.positions, triangles);
  for (int f = 0; f < 10; ++f) {
    const FrameReport report = (*solver)->advance_frame(state);
    const std::vector<Vec3> x = positions(**solver, state, 0);
    std::vector<Vec3> body;
    (*solver)->collider_positions(state, body);
    EXPECT_TRUE(exact_own_crossings(x, triangles).empty()) << f;
    EXPECT_TRUE(exact_crossings(x, triangles, body, (*solver)->collider_triangles()).empty()) << f;
    EXPECT_TRUE(exact_crossings(body, (*solver)->collider_triangles(), x, triangles).empty()) << f;
    EXPECT_EQ(report.crossings_body + report.crossings_self, 0) << f;
    EXPECT_LT(summary(edge_strains(rest, x)).p99, 0.1) << f;
    EXPECT_LE(summary(edge_strains(rest, x)).max, report.strain_max) << f;  // which is of both garments
  }
}

TEST(RidingSolver, Goes_on_from_a_saved_state_as_if_nothing_had_been) {
  const ClothSetup setup = over_balls(true, true);
  auto solver = make_cloth_solver(setup), other = make_cloth_solver(setup);
  State state = (*solver)->initial_state();
  for (int f = 0; f < 3; ++f) (*solver)->advance_frame(state);
  auto restored = load_state(save(state));
  ASSERT_TRUE(restored);
  for (int f = 0; f < 3; ++f) {
    (*solver)->advance_frame(state);
    (*other)->advance_frame(*restored);
    EXPECT_EQ(hash(state), hash(*restored)) << f;
  }
}

TEST(RidingSolver, A_pin_on_a_tiny_vertex_holds_the_vertex_that_stands_for_it) {
  ClothGarment given = garment("g", 0, true);
  const int last = given.mesh.vertex_count() - 1;
  given.pins.push_back({{}, {last, 0, last - 1}, {0.25, 0.5, 1}});
  const auto moves = without_short_edges(given);
  ASSERT_TRUE(moves);
  const ClothPin& pin = moves->garment.pins[0];
  ASSERT_EQ(pin.vertices.size(), 2u);
  EXPECT_EQ(pin.weights.size(), 2u);
  for (const int v : pin.vertices)
    EXPECT_LT(std::min((moves->garment.mesh.positions[at(v)] - given.mesh.positions[0]).norm(),
                       (moves->garment.mesh.positions[at(v)] - given.mesh.positions[at(last)]).norm()),
              3 * k_tiny);
}

TEST(RidingSolver, Stitches_of_tiny_vertices_are_sewn_to_what_stands_for_them_once) {
  ClothGarment given = garment("g", 0, true);
  const int last = given.mesh.vertex_count() - 1;  // two of one spot
  given.mesh.stitches = {{0, {last, last}, 0, 0}, {0, {last - 1, last - 1}, 0, 0}, {last, {last - 1, last - 1}, 0, 0}};
  const auto moves = without_short_edges(given);
  ASSERT_TRUE(moves);
  ASSERT_EQ(moves->garment.mesh.stitches.size(), 1u);
  const Stitch& s = moves->garment.mesh.stitches[0];
  EXPECT_EQ(moves->kept[at(s.vertex)], 0);
  EXPECT_EQ(s.edge[0], s.edge[1]);
  EXPECT_EQ(s.edge[0], moves->into[at(last)]);
}

TEST(RidingSolver, A_preview_of_such_a_garment_is_one_of_what_moves) {
  ClothSetup setup = over_balls(true, false);
  setup.coarsen = 2;
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver);
  State state = (*solver)->initial_state();
  for (int f = 0; f < 4; ++f) EXPECT_TRUE((*solver)->advance_frame(state).finite);
  EXPECT_EQ(positions(**solver, state, 0).size(), setup.garments[0].mesh.positions.size());
}

/// A garment, what of it moves, and what rides.
struct SpottedSheet {
  ClothGarment given = garment("g", 0, true);
  CoarseGarment moves = without_short_edges(given).value();
  AllRiders riders;

  SpottedSheet() {
    riders.add(given, &moves);
    riders.finish();
  }
};

TEST(RidingSolver, What_is_drawn_in_lies_nearer_around_its_vertex_as_it_did_at_rest) {
  const SpottedSheet sheet;
  const AllRiders& riders = sheet.riders;
  const Riders& own = riders.garment(0);
  std::vector<double> drawn_in(own.group_count(), 0.0);
  drawn_in[1] = 1;
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vec3> moved, x(sheet.given.mesh.positions.size());
  for (const Vec3& p : sheet.moves.garment.mesh.positions) moved.push_back(turn * p);
  own.place(moved, drawn_in, x);
  int nearer = 0;
  for (std::size_t v = 0; v < x.size(); ++v) {
    const Vec3 centre = moved[at(sheet.moves.into[v])], given_there = turn * sheet.given.mesh.positions[v];
    const double share = own.group[v] == 1 ? 1.0 / 8 : 1;
    EXPECT_LT((x[v] - (centre + share * (given_there - centre))).norm(), 1e-15);
    nearer += own.group[v] == 1;
  }
  EXPECT_GE(nearer, 4);
}

TEST(RidingSolver, A_spot_turns_with_the_cloth_around_it_and_does_not_strain_with_it) {
  const SpottedSheet sheet;
  const Riders& own = sheet.riders.garment(0);
  const std::vector<double> drawn_in(own.group_count(), 0.0);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  std::vector<Vec3> moved, x(sheet.given.mesh.positions.size());
  for (const Vec3& p : sheet.moves.garment.mesh.positions)
    moved.push_back(turn * Vec3(1.3 * p.x(), p.y(), 1.3 * p.z()));
  own.place(moved, drawn_in, x);
  for (std::size_t v = 0; v < x.size(); ++v) {
    const auto centre = at(sheet.moves.into[v]);
    const Vec3 as_given = sheet.given.mesh.positions[v] - sheet.moves.garment.mesh.positions[centre];
    EXPECT_LT((x[v] - moved[centre] - turn * as_given).norm(), 1e-15) << v;
  }
}

TEST(RidingSolver, What_rides_beside_what_rides_elsewhere_stays_on_the_triangles) {
  ClothGarment given;
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  for (int i = 0; i < 40; ++i) {  // columns of a strip, 24 of which are close together
    const double along = 0.02 * std::min(i, 8) + 1e-4 * std::clamp(i - 8, 0, 24) + 0.02 * std::max(i - 32, 0);
    for (int j = 0; j < 3; ++j) points.emplace_back(along, 0, 0.02 * j);
  }
  for (int i = 0; i < 39; ++i)
    for (int j = 0; j < 2; ++j) {
      const int a = 3 * i + j;
      triangles.insert(triangles.end(), {{a, a + 1, a + 4}, {a, a + 4, a + 3}});
    }
  given.mesh = make_triangle_mesh("strip", std::move(points), triangles);
  const auto moves = without_short_edges(given);
  ASSERT_TRUE(moves);
  AllRiders riders;
  riders.add(given, &*moves);
  riders.finish();
  const Riders& own = riders.garment(0);
  EXPECT_GT(std::count(own.alone.begin(), own.alone.end(), 0), 3);
  const Vec3 stretch(1.2, 1, 0.9);
  std::vector<Vec3> moved, x(given.mesh.positions.size());
  for (const Vec3& p : moves->garment.mesh.positions) moved.push_back(stretch.cwiseProduct(p));
  own.place(moved, std::vector<double>(own.group_count(), 0.0), x);
  for (std::size_t v = 0; v < x.size(); ++v) {
    if (own.group[v] < 0 || own.alone[at(own.group[v])] != 0) continue;
    EXPECT_LT((x[v] - stretch.cwiseProduct(given.mesh.positions[v])).norm(), 1e-15) << v;
  }
}

TEST(RidingSolver, Of_what_rides_crossings_are_found_and_only_of_that) {
  const SpottedSheet sheet;
  const AllRiders& riders = sheet.riders;
  std::vector<Vec3> x = sheet.given.mesh.positions;
  const std::vector<Vec3> needle = {{-0.15, 0.1, -0.15}, {-0.15, -0.1, -0.15}, {-0.15, -0.1, -0.151}};
  const std::vector<Triangle> one = {{0, 1, 2}};
  CheckedSurface body(one);
  body.move(needle);
  const RidingCrossings all = riders.all_crossings(x, body), of_riders = riders.crossings(x, body);
  EXPECT_FALSE(all.with_body.empty());
  EXPECT_TRUE(all.own.empty());
  const auto rides = [&](int v) { return riders.garment(0).group[at(v)] >= 0; };
  std::size_t expected = 0;
  for (const Crossing& c : all.with_body)
    expected += c.edge_of_first ? rides(c.edge[0]) || rides(c.edge[1])
                                : rides(c.triangle[0]) || rides(c.triangle[1]) || rides(c.triangle[2]);
  EXPECT_EQ(of_riders.with_body.size(), expected);
  // A rider that is pulled through its neighbours.
  for (std::size_t v = 0; v < x.size(); ++v)
    if (rides(static_cast<int>(v))) {
      x[v] += Vec3(0.03, 0, 0.004);
      break;
    }
  EXPECT_EQ(riders.crossings(x, body).own, riders.all_crossings(x, body).own);
  EXPECT_FALSE(riders.crossings(x, body).own.empty());
}

}  // namespace
}  // namespace ft

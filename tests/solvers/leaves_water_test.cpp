// Leaves on water, against closed forms: where they lie, waves that they ride, the wind that drives them; and what
// pushes them under, runs dry or stands in the way.
#include "solvers/leaves/leaf_float.h"
#include "tests/solvers/leaf_scenes.h"

namespace ft {
namespace {

using namespace test;
using std::numbers::pi;

using Heights = std::function<double(double x, double z, double t)>;
using Flows = std::function<Vec3(double x, double z, double t)>;

/// A surface of so many cells either way about the origin, that is as high and flows as said.
LeafWater water_of(double side, int cells, Heights height, Flows flow = {}) {
  struct Flow final : VertexFlow {
    std::vector<Vec3> places;
    Flows formula;
    void sample(double time, std::span<Vec3> out) const override {
      for (std::size_t i = 0; i < out.size(); ++i) out[i] = formula(places[i].x(), places[i].z(), time);
    }
  };
  LeafWater out;
  out.name = "pond";
  std::vector<Vec3> bind;
  for (int k = 0; k <= cells; ++k)
    for (int i = 0; i <= cells; ++i)
      bind.emplace_back(side * (1.0 * i / cells - 0.5), 0, side * (1.0 * k / cells - 0.5));
  Surface surface;
  surface.part_of_vertex.assign(bind.size(), 0);
  surface.parts.emplace_back();
  const int row = cells + 1;
  for (int k = 0; k < cells; ++k)
    for (int i = 0; i < cells; ++i) {
      const int v = row * k + i;
      surface.triangles.push_back({v, v + row, v + row + 1});
      surface.triangles.push_back({v, v + row + 1, v + 1});
    }
  out.surface = std::make_shared<ScriptedBody>(surface, bind, 0, [height](double time, std::span<Vec3> x) {
    for (Vec3& p : x) p.y() = height(p.x(), p.z(), time);
  });
  if (flow) {
    auto made = std::make_shared<Flow>();
    made->places = bind, made->formula = flow;
    out.flow = made;
  }
  return out;
}

LeafWater still_water(double side = 4, double level = 0) {
  return water_of(side, 20, [level](double, double, double) { return level; });
}

/// Waves along x with the flow at their surface, of deep water: amplitude and length [m].
LeafWater waves(double amplitude, double length, double side) {
  const double k = 2 * pi / length, w = std::sqrt(k_gravity * k);
  return water_of(
      side, 80, [=](double x, double, double t) { return amplitude * std::cos(k * x - w * t); },
      [=](double x, double, double t) { return Vec3(amplitude * w * std::cos(k * x - w * t), 0, 0); });
}

/// Of a leaf's points: lowest and highest above a height of the surface.
std::pair<double, double> span_above(const LeavesSolver& solver, const State& state, const Heights& height) {
  double least = 1e9, most = -1e9;
  for (const Vec3& p : cached_vertices(solver, state)) {
    const double above = p.y() - height(p.x(), p.z(), state.time);
    least = std::min(least, above), most = std::max(most, above);
  }
  return {least, most};
}

double lean(const LeafState& leaf) {
  const double up = std::abs((leaf.orientation * Vec3::UnitY()).y());
  return std::acos(std::min(1.0, up)) * 180 / pi;
}

constexpr double k_margins = 1.2e-3;  ///< leaves are kept between half as much and so much above what they lie on [m]

TEST(LeavesOnWater, They_fall_on_still_water_and_lie_on_it_flat_and_still) {
  LeavesSetup setup = many_leaves(100, 0.3, 0.2, 0.6);
  setup.waters.push_back(still_water());
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  for (int frame = 0; frame < 24 * 3; ++frame) {
    const FrameReport report = solver->advance_frame(state);
    ASSERT_TRUE(report.finite);
    for (const Vec3& p : cached_vertices(*solver, state)) ASSERT_GT(p.y(), -4e-3) << frame;
  }
  const auto before = leaves_of(*solver, state);
  double afloat = 0;
  for (int frame = 0; frame < 24 * 2; ++frame) afloat = solver->advance_frame(state).own.at("leaves_afloat");
  EXPECT_EQ(afloat, 100);
  const auto after = leaves_of(*solver, state);
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_LT(lean(after[i]), 1) << i;
    EXPECT_LT(after[i].velocity.norm(), 1e-3) << i;
    EXPECT_LT((after[i].position - before[i].position).norm(), 5e-3) << i;
    EXPECT_FALSE(after[i].asleep);
  }
  const auto [least, most] = span_above(*solver, state, [](double, double, double) { return 0.0; });
  EXPECT_GT(least, 0);
  // A flat leaf, which is nowhere higher than its place above the water.
  EXPECT_LT(most, k_margins + 0.5 * 0.05 * 1.25 * std::sin(0.15) + 1e-3);
}

TEST(LeavesOnWater, One_that_starts_off_level_lies_level_after_two_seconds) {
  for (const double side : {1.0, -1.0})
    for (const double off : {-1e-3, 3e-3}) {
      LeavesSetup setup = many_leaves(1, 0, 1, 0);
      setup.prototypes[0] = almond_leaf("flat", 0.08, 0.05, 0);
      setup.waters.push_back(still_water());
      setup.leaves[0].position.y() = 0.9e-3 - off;
      setup.leaves[0].orientation =
          Quat(Eigen::AngleAxisd(0.05, Vec3::UnitX())) * Quat(Eigen::AngleAxisd(side > 0 ? 0 : pi, Vec3::UnitX()));
      const auto solver = solver_of(setup);
      State state = solver->initial_state();
      for (int frame = 0; frame < 48; ++frame) solver->advance_frame(state);
      const LeafState leaf = leaves_of(*solver, state)[0];
      EXPECT_NEAR(leaf.position.y(), 0.9e-3, 0.31e-3);
      EXPECT_LT(lean(leaf), 1);
      EXPECT_TRUE(leaf.afloat);
    }
}

TEST(LeavesOnWater, They_ride_waves_that_are_longer_than_they_are) {
  for (const double length : {1.0, 2.0, 6.0}) {
    const double amplitude = 0.01 * length, k = 2 * pi / length, w = std::sqrt(k_gravity * k);
    LeavesSetup setup = many_leaves(9, 0.08, 0.2, 0);
    setup.prototypes[0] = almond_leaf("flat", 0.08, 0.05, 0);
    const LeafWater water = waves(amplitude, length, 4);
    setup.waters.push_back(water);
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    double worst = 0, worst_lean = 0, farthest = 0;
    std::vector<Vec3> first;
    for (int frame = 0; frame < 24 * 6; ++frame) {
      solver->advance_frame(state);
      if (frame < 96) continue;
      const auto leaves = leaves_of(*solver, state);
      if (first.empty())
        for (const LeafState& l : leaves) first.push_back(l.position);
      for (std::size_t i = 0; i < leaves.size(); ++i) {
        const LeafState& l = leaves[i];
        ASSERT_TRUE(l.afloat) << length << " " << frame;
        const double phase = k * l.position.x() - w * state.time;
        const double above = l.position.y() - amplitude * std::cos(phase);
        worst = std::max(worst, std::abs(above - 0.9e-3));
        const Vec3 normal = Vec3(amplitude * k * std::sin(phase), 1, 0).normalized();
        worst_lean = std::max(worst_lean, (l.orientation * Vec3::UnitY()).cross(normal).norm());
        // Round and round with the water, and back: 2 w a^2 k of drift a second are left out of linear waves.
        farthest = std::max(farthest, std::abs(l.position.x() - first[i].x()));
      }
    }
    // Each lies at a height of its own, 0.3 mm about the middle of them; the rest is what waves may take.
    EXPECT_LT(worst, 0.3e-3 + 0.03 * amplitude) << length;
    EXPECT_LT(worst_lean, 0.15 * amplitude * k) << length;
    // Round and round with the water: no farther than its own path and what drifts with it.
    EXPECT_LT(farthest, 4 * amplitude) << length;
  }
}

TEST(LeavesOnWater, Wind_drives_them_where_drag_of_water_balances_drag_of_air) {
  for (const double wind : {1.0, 3.0, 6.0}) {
    LeavesSetup setup = many_leaves(4, 2e-3, 0.3, 0);
    setup.wind = steady_wind(Vec3(wind, 0, 0));
    setup.waters.push_back(still_water(40));
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    for (int frame = 0; frame < 24 * 8; ++frame) solver->advance_frame(state);
    for (const LeafState& l : leaves_of(*solver, state)) {
      const double ratio = wind_drift(solver->plate(0));
      ASSERT_TRUE(l.afloat) << wind;
      EXPECT_NEAR(l.velocity.x(), wind * ratio / (1 + ratio), 0.05 * wind * ratio);
    }
  }
}

TEST(LeavesOnWater, What_a_body_pushes_under_comes_up_again) {
  LeavesSetup setup = many_leaves(25, 5e-3, 0.05, 0);
  setup.waters.push_back(still_water());
  // A box dips in to 8 cm and is lifted out.
  const auto way = [](double t) { return Vec3(0, -0.2 * std::sin(std::min(t, 2.0) * pi / 2), 0); };
  setup.bodies.push_back(obstacle_of("box", box_surface(Vec3(0.2, 0.1, 0.2)), Vec3(0, 0.17, 0), way));
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  double deepest = 0;
  for (int frame = 0; frame < 24 * 10; ++frame) {
    const FrameReport report = solver->advance_frame(state);
    ASSERT_EQ(report.crossings_body, 0) << frame;
    for (const LeafState& l : leaves_of(*solver, state)) deepest = std::min(deepest, l.position.y());
  }
  EXPECT_LT(deepest, -0.05) << "some are pushed under";
  const auto [least, most] = span_above(*solver, state, [](double, double, double) { return 0.0; });
  EXPECT_GT(least, 0) << "all are up again";
  EXPECT_LT(most, 0.02);
}

TEST(LeavesOnWater, Where_it_runs_dry_the_ground_has_them_and_where_it_comes_back_they_float) {
  LeavesSetup setup = many_leaves(9, 0.05, 0.2, 0.1);
  // Water sinks from 4 cm to below the ground, lies there as water does that is dry, and comes back.
  setup.waters.push_back(water_of(2, 10, [](double, double, double t) {
    return std::max(-2e-3, 0.04 * std::cos(std::min(2 * pi, std::max(0.0, t - 2) * 0.5)));
  }));
  setup.grounds.push_back({});
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  double afloat = 0, awake = 0;
  const auto run_to = [&](double time) {
    while (state.time < time) {
      const FrameReport report = solver->advance_frame(state);
      afloat = report.own.at("leaves_afloat"), awake = report.own.at("leaves_awake");
      for (const Vec3& p : cached_vertices(*solver, state)) ASSERT_GT(p.y(), 0) << state.time;
    }
  };
  run_to(2);
  EXPECT_EQ(afloat, 9);
  run_to(9);  // dry from 5.2 to 11.3 s
  EXPECT_EQ(afloat, 0);
  EXPECT_EQ(awake, 0) << "they lie on the ground, and sleep";
  run_to(15);
  EXPECT_EQ(afloat, 9);
  for (const LeafState& l : leaves_of(*solver, state)) EXPECT_NEAR(l.position.y(), 0.04, 5e-3);
}

TEST(LeavesOnWater, A_state_that_was_saved_goes_on_to_the_same_bytes) {
  LeavesSetup setup = many_leaves(30, 0.3, 0.12, 0.6);
  setup.wind = steady_wind(Vec3(2, 0, 1));
  setup.waters.push_back(waves(0.02, 2, 4));
  const auto solver = solver_of(setup), other = solver_of(setup);
  State state = solver->initial_state();
  for (int frame = 0; frame < 30; ++frame) solver->advance_frame(state);
  auto loaded = load_state(save(state));
  ASSERT_TRUE(loaded) << loaded.error().text();
  for (int frame = 0; frame < 30; ++frame) {
    solver->advance_frame(state), other->advance_frame(*loaded);
    ASSERT_EQ(hash(state).hex(), hash(*loaded).hex()) << frame;
  }
}

TEST(LeavesOnWater, A_surface_whose_vertices_are_no_grid_is_refused) {
  LeavesSetup setup = many_leaves(1, 0.1, 1, 0);
  setup.waters.push_back({"blob", obstacle_of("blob", box_surface(Vec3(1, 1, 1)), Vec3::Zero()).trajectory});
  const auto solver = LeavesSolver::make(setup);
  ASSERT_FALSE(solver);
  EXPECT_NE(solver.error().text().find("\"blob\" is no surface to float on"), std::string::npos)
      << solver.error().text();
}

}  // namespace
}  // namespace ft

// Zips: they open and close from one end to the other, for any number of threads, after a resume and in a preview.
#include "baker/core/parallel.h"
#include "tests/solvers/strips.h"

namespace ft {
namespace {

TEST(Zip, A_zip_lets_go_one_point_after_another_and_closes_the_other_way_round) {
  ClothPin zip = pin_of({2, 6, 10, 14, 18});
  zip.hold.from = -9, zip.hold.until = 1, zip.hold.fade = 2;
  const Mesh mesh = strip("side", 0, 0).mesh;
  for (const HoldSpan& hold : hold_spans(zip, mesh.positions)) {
    EXPECT_EQ(hold.until, 1);
    EXPECT_EQ(hold.fade, 2);
  }
  zip.opens = Vec3(0, -1, 0);
  const auto down = hold_spans(zip, mesh.positions);
  for (std::size_t i = 0; i < 5; ++i) {
    const double step = 0.4 * static_cast<double>(i);
    EXPECT_NEAR(down[i].until, 1 + step, 1e-12);
    EXPECT_NEAR(down[i].from, -9 + 1.6 - step, 1e-12);
    EXPECT_NEAR(down[i].fade, 0.4, 1e-12) << "evenly, and the last is gone after the whole time";
  }
  zip.opens = Vec3(0, 0.3, 0);
  const auto up = hold_spans(zip, mesh.positions);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(up[i].until, down[4 - i].until, 1e-12);
  zip.opens = Vec3(0, 0, 1);
  for (const HoldSpan& hold : hold_spans(zip, mesh.positions)) EXPECT_EQ(hold.until, 1) << "no extent that way";
}

/// Two flaps side by side, closed by cords of 3 mm. The left one is held all over, the right one at its far border; it
/// is drawn out of the plane where it is open, from its top downwards in the frames 2 to 22.
ClothSetup flaps() {
  ClothGarment left = strip("left", 0, 0), right = strip("right", 0.063, 0);
  std::vector<int> all, edge, far;
  for (int i = 0; i < k_strip; ++i) all.push_back(i);
  for (int j = 0; j <= k_rows; ++j) edge.push_back(4 * j), far.push_back(4 * j + 3);
  left.pins.push_back(pin_of(all));
  right.pins = {pin_of(edge, 0), pin_of(far)};
  ClothSetup setup = in_vacuum({left, right});
  setup.gravity = Vec3(0, 0, 2);
  ClothPin& zip = setup.garments[1].pins[0];
  zip.hold.until = 2 / setup.fps, zip.hold.fade = 20 / setup.fps;
  zip.opens = Vec3(0, -1, 0);
  return setup;
}

std::vector<double> gaps(const State& state) {
  const auto x = as_points(*state.find("x"));
  std::vector<double> out;
  for (int j = 0; j <= k_rows; ++j) out.push_back((x[at(k_strip + 4 * j)] - x[at(4 * j + 3)]).norm());
  return out;
}

TEST(Zip, A_zip_that_is_open_half_way_holds_its_lower_half_only) {
  const auto states = states_of(flaps(), 30);
  for (const double gap : gaps(states[2])) EXPECT_LT(gap, 3.5e-3);
  const auto half = gaps(states[12]);
  EXPECT_GT(half[0], 6e-3) << "twice as far as closed";
  for (int j = 6; j <= k_rows; ++j) EXPECT_LT(half[at(j)], 3.5e-3) << j;
  for (int j = 0; j < 4; ++j) EXPECT_GT(half[at(j)], half[at(j + 1)]) << j;
  for (const double gap : gaps(states[30])) EXPECT_GT(gap, 0.02);
}

TEST(Zip, A_zip_that_closes_later_draws_the_sides_together) {
  ClothSetup setup = flaps();
  setup.gravity = Vec3(0, 0, 0.5);
  HoldSpan& hold = setup.garments[1].pins[0].hold;
  hold = {};
  hold.from = 12 / setup.fps, hold.fade = 12 / setup.fps;
  const auto states = states_of(setup, 48);
  EXPECT_GT(gaps(states[12])[0], 5e-3);
  const auto half = gaps(states[18]);
  EXPECT_LT(half[k_rows], 3.5e-3) << "from the lower end";
  EXPECT_GT(half[0], 4e-3);
  for (const double gap : gaps(states[48])) EXPECT_LT(gap, 3.5e-3);
}

TEST(Zip, The_same_bits_for_any_number_of_threads_and_after_a_resume_in_the_middle_of_the_opening) {
  const ClothSetup setup = flaps();
  std::vector<State> states;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    const auto run = states_of(setup, 16);
    if (!states.empty()) {
      EXPECT_EQ(hash(run.back()), hash(states.back()));
    }
    states = run;
  }
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver);
  auto state = load_state(save(states[9]));
  ASSERT_TRUE(state);
  while (state->frame < 16) (*solver)->advance_frame(*state);
  EXPECT_EQ(hash(*state), hash(states[16]));
}

TEST(Zip, A_preview_is_held_and_opens_as_the_final_bake_is) {
  ClothSetup setup = flaps();
  // Fine enough to be made coarser.
  for (ClothGarment& g : setup.garments) {
    const Vec3 corner = g.mesh.positions[0];
    g.mesh = rectangle_mesh(9, 27, [&](double s, double t) { return Vec3(corner + Vec3(0.06 * s, -0.18 * t, 0)); });
    for (ClothPin& pin : g.pins) {
      std::vector<int> vertices;
      for (int v = 0; v < g.mesh.vertex_count(); ++v) {
        const bool edge = v % 10 == 0, far = v % 10 == 9;
        if (&g == &setup.garments[0] || (pin.to >= 0 ? edge : far)) vertices.push_back(v);
      }
      pin.vertices = vertices;
    }
  }
  setup.coarsen = 2;
  auto solver = make_cloth_solver(setup);
  ASSERT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  std::vector<Vec3> left(280), right(280);
  const auto gap = [&](int j) {
    (*solver)->system_positions(state, 0, left);
    (*solver)->system_positions(state, 1, right);
    return (left[at(10 * j + 9)] - right[at(10 * j)]).norm();
  };
  while (state.frame < 12) {
    (*solver)->advance_frame(state);
    if (state.frame == 2) {
      for (int j = 0; j <= 27; ++j) EXPECT_LT(gap(j), 4e-3) << j;
    }
  }
  EXPECT_GT(gap(0), 6e-3);
  for (int j = 18; j <= 27; ++j) EXPECT_LT(gap(j), 4e-3) << j;
}

TEST(Zip, Sides_that_touch_in_the_bind_pose_come_to_lie_at_the_contact_distance_without_a_fight) {
  for (const double apart : {0.0, 1e-6, 1e-3}) {
    ClothSetup setup = flaps();
    for (Vec3& x : setup.garments[1].mesh.positions) x.x() -= 3e-3 - apart;
    setup.garments[1].pins[0].hold = {};
    const double touching = ContactModel::self_radius(model_of(setup)->contact.radius[0]);
    auto solver = make_cloth_solver(setup);
    ASSERT_TRUE(solver);
    State state = (*solver)->initial_state();
    for (int f = 1; f <= 12; ++f) {
      const FrameReport report = (*solver)->advance_frame(state);
      EXPECT_EQ(report.crossings_self, 0) << apart << " " << f;
      EXPECT_LT(report.strain_max, 0.01) << apart << " " << f;
      for (const double gap : gaps(state)) EXPECT_NEAR(gap, touching, 0.01 * touching) << apart << " " << f;
    }
  }
}

}  // namespace
}  // namespace ft

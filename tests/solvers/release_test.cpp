// Pins that let go and take hold at a frame: free fall from the very instant, the same bits before it, and after a
// resume.
#include <gtest/gtest.h>

#include "solvers/cloth/cloth_solver.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

constexpr int k_cells = 6;
constexpr double k_fps = 24;

/// A sheet at y = 1 in vacuum, alone; `vertices` of it are pinned (none: all).
ClothSetup held_sheet(std::vector<int> vertices = {}) {
  ClothSetup setup;
  setup.first_frame = 0;
  setup.preroll_frames = 0;
  setup.fps = k_fps;
  setup.air_density = 0;
  ClothGarment sheet;
  sheet.name = "sheet";
  sheet.mesh = make_sheet(0.2, k_cells, 1);
  ClothPin pin;
  pin.vertices = std::move(vertices);
  if (pin.vertices.empty())
    for (int i = 0; i < sheet.mesh.vertex_count(); ++i) pin.vertices.push_back(i);
  sheet.pins.push_back(pin);
  setup.garments.push_back(std::move(sheet));
  return setup;
}

HoldSpan until_frame(double frame, double fade = 0) {
  HoldSpan hold;
  hold.until = frame / k_fps, hold.fade = fade / k_fps;
  return hold;
}

/// States at the frames 0, 1, 2, ...
std::vector<State> states_of(const ClothSetup& setup, int frames) {
  auto solver = make_cloth_solver(setup);
  EXPECT_TRUE(solver) << (solver ? "" : solver.error().text());
  std::vector<State> out = {(*solver)->initial_state()};
  for (int f = 0; f < frames; ++f) {
    out.push_back(out.back());
    (*solver)->advance_frame(out.back());
  }
  return out;
}

/// Mean of a block ("x", "v") of a sheet's vertices, weighted by their mass: a third of every triangle around them.
Vec3 mean_of(const State& state, const char* block) {
  const Mesh mesh = make_sheet(0.2, k_cells, 1);
  const auto values = as_points(*state.find(block));
  Vec3 sum = Vec3::Zero();
  for (const Triangle& t : triangulate(mesh))
    for (const int v : t) sum += values[at(v)];
  return sum / (3 * 2 * k_cells * k_cells);
}

Vec3 centre_of(const State& state) {
  return mean_of(state, "x");
}

TEST(HoldSpan, is_whole_up_to_its_end_and_fades_linearly) {
  const HoldSpan always;
  EXPECT_EQ(always.share(-1e9), 1);
  EXPECT_EQ(always.share(1e9), 1);
  EXPECT_FALSE(always.jumps(-1, 1));
  HoldSpan hard;
  hard.from = 1, hard.until = 2;
  EXPECT_EQ(hard.share(1), 0);
  EXPECT_EQ(hard.share(1.001), 1);
  EXPECT_EQ(hard.share(2), 1);
  EXPECT_EQ(hard.share(2 + 1e-15), 1) << "the same instant, computed otherwise";
  EXPECT_EQ(hard.share(2.001), 0);
  EXPECT_TRUE(hard.jumps(0.9, 1.1));
  EXPECT_TRUE(hard.jumps(2, 2.1));
  EXPECT_FALSE(hard.jumps(1.9, 2));
  HoldSpan soft = hard;
  soft.fade = 0.5;
  EXPECT_EQ(soft.share(1), 0);
  EXPECT_NEAR(soft.share(1.25), 0.5, 1e-15);
  EXPECT_EQ(soft.share(1.5), 1);
  EXPECT_EQ(soft.share(2), 1);
  EXPECT_NEAR(soft.share(2.1), 0.8, 1e-15);
  EXPECT_EQ(soft.share(2.5), 0);
  EXPECT_EQ(soft.share(3), 0);
  EXPECT_FALSE(soft.jumps(0, 3));
}

TEST(Release, A_held_square_falls_freely_from_the_frame_at_which_it_is_let_go) {
  ClothSetup setup = held_sheet();
  const int release = 5, frames = 29;
  const auto held = states_of(setup, release);
  setup.garments[0].pins[0].hold = until_frame(release);
  const auto states = states_of(setup, frames);
  EXPECT_EQ(hash(states[at(release)]), hash(held.back())) << "nothing differs before";
  const Vec3 start = centre_of(states[at(release)]);
  // The integrator's first step after the jump is of first order: it is off by 3/4 h2 g in all, and that does not grow.
  const double h = 1 / (k_fps * setup.min_substeps), once = h * h * k_gravity;
  for (int f = release + 1; f <= frames; ++f) {
    const double t = (f - release) / k_fps;
    const Vec3 expected = start + Vec3(0, -0.5 * k_gravity * t * t, 0);
    EXPECT_LT((centre_of(states[at(f)]) - expected).norm(), once) << f;
    const auto x = as_points(*states[at(f)].find("x"));
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_NEAR(x[i].y() - start.y(), expected.y() - start.y(), 1.2 * once) << f << " " << i;
  }
}

TEST(Release, A_hanging_square_takes_its_momentum_along_when_it_is_let_go) {
  ClothSetup setup = held_sheet({0, k_cells});  // two corners: it swings down and is let go on its way
  setup.garments[0].pins[0].hold = until_frame(4);
  setup.garments[0].self_collision = false;
  setup.linear_tolerance = 1e-6;
  setup.newton_iterations = 8;
  const auto states = states_of(setup, 20);
  const Vec3 speed = mean_of(states[4], "v");
  ASSERT_GT(speed.norm(), 0.3);
  const double h = 1 / (k_fps * setup.min_substeps);
  for (int f = 5; f <= 20; ++f) {
    const double t = (f - 4) / k_fps;
    const Vec3 expected = centre_of(states[4]) + t * speed + Vec3(0, -0.5 * k_gravity * t * t, 0);
    EXPECT_LT((centre_of(states[at(f)]) - expected).norm(), h * h * k_gravity) << f;
  }
}

TEST(Release, A_pin_that_fades_holds_less_and_less_and_then_nothing) {
  ClothSetup setup = held_sheet();
  setup.garments[0].pins[0].stiffness = 2e3;  // soft: its sag of 0.7 mm can be seen to grow
  const auto held = states_of(setup, 12);
  setup.garments[0].pins[0].hold = until_frame(12, 12);
  const auto states = states_of(setup, 36);
  EXPECT_EQ(hash(states[12]), hash(held.back()));
  const double sag = setup.garments[0].fabric.mass_per_area * k_gravity / 2e3;
  EXPECT_NEAR(1 - centre_of(states[12]).y(), sag, 0.02 * sag);
  // Half-way through, the spring is half as stiff; the cloth follows it with some delay.
  EXPECT_NEAR(1 - centre_of(states[18]).y(), 2 * sag, 0.2 * sag);
  // From the frame after the fade on, every second difference is that of free fall.
  for (int f = 26; f < 36; ++f) {
    const double bend =
        centre_of(states[at(f + 1)]).y() - 2 * centre_of(states[at(f)]).y() + centre_of(states[at(f - 1)]).y();
    EXPECT_NEAR(bend, -k_gravity / (k_fps * k_fps), 1e-3 * k_gravity / (k_fps * k_fps)) << f;
  }
}

TEST(Release, A_pin_that_begins_later_lets_the_cloth_fall_first_and_then_draws_it_back) {
  ClothSetup setup = held_sheet(), free = setup;
  free.garments[0].pins.clear();
  setup.garments[0].pins[0].hold.from = 4 / k_fps;
  const auto falling = states_of(free, 4), states = states_of(setup, 60);
  EXPECT_EQ(hash(states[4]), hash(falling.back()));
  EXPECT_NEAR(1 - centre_of(states[4]).y(), 0.5 * k_gravity * 16 / (k_fps * k_fps), 1e-6);
  EXPECT_NEAR(centre_of(states[60]).y(), 1, 1e-4);
}

TEST(Release, A_resume_before_at_and_after_the_release_gives_the_same_bits) {
  for (const double fade : {0.0, 3.0}) {
    ClothSetup setup = held_sheet({0, k_cells});
    setup.garments[0].pins[0].hold = until_frame(5, fade);
    const auto states = states_of(setup, 12);
    for (const int from : {3, 5, 6, 7}) {
      auto solver = make_cloth_solver(setup);
      ASSERT_TRUE(solver);
      auto state = load_state(save(states[at(from)]));
      ASSERT_TRUE(state);
      while (state->frame < 12) (*solver)->advance_frame(*state);
      EXPECT_EQ(hash(*state), hash(states[12])) << from << " " << fade;
    }
  }
}

}  // namespace
}  // namespace ft

// The pond as a solver: its edges, its faults, the same bytes whatever the threads and wherever a bake was cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "baker/core/parallel.h"
#include "tests/solvers/pond_scenes.h"

namespace ft {
namespace {

/// A packet of waves of that length that runs towards +x, in the middle of a long pool.
State packet(const PondSolver& pond, double length, double width) {
  State state = pond.initial_state();
  const PondModes& m = pond.modes();
  auto& eta = state.block("eta");
  auto& potential = state.block("potential");
  const double k = 2 * std::numbers::pi / length, omega = std::sqrt(m.gravity * k * std::tanh(k * m.depth));
  for (int j = 0; j < m.nz; ++j)
    for (int i = 0; i < m.nx; ++i) {
      const double x = (i + 0.5) * m.cell_x() - 0.35 * m.length_x, hull = 0.01 * std::exp(-x * x / (2 * width * width));
      eta[at(j * m.stride + i)] = hull * std::cos(k * x);
      potential[at(j * m.stride + i)] = hull * m.gravity / omega * std::sin(k * x);
    }
  m.transform.to_waves(eta);
  m.transform.to_waves(potential);
  return state;
}

PondSetup channel(PondEdge edges) {
  PondSetup s;
  s.size_x = 40, s.size_z = 20;
  s.nx = 512, s.nz = 16;
  s.depth = 5;
  s.gravity = 9.81;
  s.edges = edges;
  s.rim = 5;
  return s;
}

// A packet runs against a rim 5 m wide, and what is left has had the time to come back.
TEST(PondBake, An_open_rim_takes_the_waves_that_reach_it) {
  for (const double length : {1.0, 2.5, 5.0, 10.0}) {
    PondSetup s = channel(PondEdge::k_open);
    s.size_x = 60;
    const auto pond = made(s);
    State state = packet(*pond, length, 1.2 * std::max(length, 2.0));
    const double before = pond->energy(state).waves, water = pond->ledger(state).total();
    const double k = 2 * std::numbers::pi / length,
                 group = 0.5 * std::sqrt(9.81 / k * std::tanh(k * 5)) * (1 + 2 * k * 5 / std::sinh(2 * k * 5));
    const double time = (0.65 * 60 + 25) / group;
    PondReport r;
    while (state.time < time) r = pond->advance_frame(state, 1.0 / 12, {});
    const double amplitude = std::sqrt(std::max(r.energy.waves, 0.0) / before);
    if (std::getenv("POND_SHOW"))
      std::printf("length %.1f: %.4f of the amplitude, ledger %.3g\n", length, amplitude, r.ledger.total() - water);
    EXPECT_LT(amplitude, length > s.rim ? 0.1 : 0.02) << length;
    EXPECT_NEAR(r.energy.absorbed + r.energy.waves, before, 1e-3 * before);
    EXPECT_NEAR(r.ledger.total(), water, 1e-12 * water);
  }
}

TEST(PondBake, Walls_send_waves_back_whole) {
  const auto pond = made(channel(PondEdge::k_wall));
  State state = packet(*pond, 2, 2.4);
  const double before = pond->energy(state).waves;
  PondReport r;
  while (state.time < 20) r = pond->advance_frame(state, 1.0 / 24, {});
  EXPECT_NEAR(r.energy.waves, before, 1e-3 * before);
  EXPECT_NEAR(r.ledger.total(), 4000, 1e-12 * 4000);
  EXPECT_EQ(r.ledger.outflow, 0);
}

TEST(PondBake, Wind_ruffles_the_water_to_a_size_and_no_more) {
  PondSetup s = square_pond(10, 128, 2);
  s.wind = Vec2(4, 1);
  const auto pond = made(s);
  State state = pond->initial_state();
  std::vector<double> h(at(128 * 128));
  double early = 0, late = 0;
  for (int f = 0; f < 480; ++f) {
    pond->advance_frame(state, 1.0 / 24, {});
    if (f != 239 && f != 479) continue;
    pond->surface_heights(state, h);
    double sum = 0;
    for (const double x : h) sum += x * x;
    (f == 239 ? early : late) = std::sqrt(sum / static_cast<double>(h.size()));
  }
  if (std::getenv("POND_SHOW")) std::printf("ruffle %.2g %.2g m\n", early, late);
  EXPECT_GT(late, 1e-4);
  EXPECT_LT(late, 0.03);
  EXPECT_NEAR(early, late, 0.3 * late);
}

PondSetup busy() {
  PondSetup s = square_pond(6, 48, 2);
  s.nz = 44;
  s.wind = Vec2(2, 3);
  s.edges = PondEdge::k_open;
  s.floats.push_back(floating_ball(0.2, 0.4, Vec3(2, 0.8, 2.4), "ball"));
  s.floats.push_back(floating_ball(0.2, 2.4, Vec3(2.5, 0.5, 4), "stone"));
  s.floats.push_back(floating_box(Vec3(0.8, 0.2, 0.4), 0.5, Vec3(4, 0.2, 3)));
  return s;
}

PondReport advance_busy(const PondSolver& pond, State& state) {
  static const TriangleSurface skin = capsule_surface(0.12, 1.2, 2);
  const auto at_time = [&](double t) {
    std::vector<Vec3> out = skin.positions;
    for (Vec3& p : out) p += Vec3(3.1 + 0.1 * t, 1.6 - 9 * t, 1.4);
    return out;
  };
  const auto from = at_time(state.time), to = at_time(state.time + 1.0 / 24);
  const DrivenBody body{skin.triangles, from, to};
  return pond.advance_frame(state, 1.0 / 24, {&body, 1});
}

TEST(PondBake, One_thread_and_two_make_the_same_bytes) {
  const auto pond = made(busy());
  Hash128 hashes[2];
  for (int threads = 1; threads <= 2; ++threads) {
    const ThreadLimit limit(threads);
    State state = pond->initial_state();
    for (int f = 0; f < 20; ++f) advance_busy(*pond, state);
    hashes[threads - 1] = hash(state);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(PondBake, A_bake_goes_on_from_any_frame_as_if_it_had_not_stopped) {
  const auto pond = made(busy());
  State whole = pond->initial_state();
  std::vector<Hash128> hashes;
  std::vector<Bytes> saves;
  for (int f = 0; f < 24; ++f) {
    saves.push_back(save(whole));
    advance_busy(*pond, whole);
    hashes.push_back(hash(whole));
  }
  for (const std::size_t cut : {std::size_t{0}, std::size_t{4}, std::size_t{6}, std::size_t{9}, std::size_t{15}}) {
    const auto other = made(busy());
    auto loaded = load_state(saves[cut]);
    ASSERT_TRUE(loaded.ok());
    State state = *loaded;
    for (std::size_t f = cut; f < 24; ++f) advance_busy(*other, state);
    EXPECT_EQ(hash(state), hashes.back()) << "cut at " << cut;
  }
}

TEST(PondBake, All_the_water_is_accounted_for_over_a_whole_bake) {
  const auto pond = made(busy());
  State state = pond->initial_state();
  const double before = pond->ledger(state).total();
  double worst = 0, most = 0;
  for (int f = 0; f < 96; ++f) {
    const PondReport r = advance_busy(*pond, state);
    ASSERT_TRUE(r.finite);
    worst = std::max(worst, std::abs(r.ledger.total() - before));
    most = std::max(most, r.ledger.droplets - r.ledger.cavities);
  }
  EXPECT_GT(most, 1e-3);
  EXPECT_LT(worst, 1e-12 * before);
}

TEST(PondBake, Water_at_rest_stays_at_rest) {
  PondSetup s = square_pond(4, 32, 2);
  s.floats.push_back(floating_box(Vec3(0.6, 0.2, 0.4), 0.5, Vec3(2, 0, 2)));
  const auto pond = made(s);
  State state = pond->initial_state();
  for (int f = 0; f < 48; ++f) pond->advance_frame(state, 1.0 / 24, {});
  for (const double h : *state.find("height")) ASSERT_LT(std::abs(h), 1e-12);
  EXPECT_LT(pond->float_motions(state)[0].velocity.norm(), 1e-12);
}

std::string fault(PondSetup s) {
  auto out = PondSolver::make(std::move(s));
  return out.ok() ? "" : out.error().text();
}

TEST(PondBake, Setups_that_make_no_sense_are_refused_by_name_and_number) {
  PondSetup s = square_pond(2, 32, 1);
  EXPECT_EQ(fault(s), "");
  s.depth = -0.5;
  EXPECT_NE(fault(s).find("depth = -0.5 m: the pond is dry"), std::string::npos);
  s = square_pond(2, 31, 1);
  EXPECT_NE(fault(s).find("nx = 31 has to be even"), std::string::npos);
  s = square_pond(2, 4096, 1);
  s.floats.assign(40, floating_ball(0.1, 0.5, Vec3(1, 0, 1)));
  EXPECT_NE(fault(s).find("GB; the limit is"), std::string::npos);
  s = square_pond(2, 32, 1);
  s.floats.push_back(floating_box(Vec3(3, 0.2, 0.4), 0.5, Vec3(1, 0, 1), "barge"));
  EXPECT_NE(fault(s).find("\"barge\": is 3 x 0.4 m and the pond 2 x 2 m"), std::string::npos);
  s.floats = {floating_ball(0.2, 0.5, Vec3(0.8, 0, 1), "a"), floating_ball(0.2, 0.5, Vec3(1.1, 0, 1), "b")};
  EXPECT_NE(fault(s).find("\"a\" and \"b\" overlap by 0.1 m"), std::string::npos);
  s.floats = {floating_ball(0.2, 0.5, Vec3(0.1, 0, 1), "a")};
  EXPECT_NE(fault(s).find("starts outside the pond"), std::string::npos);
  s.floats = {floating_ball(0.2, 0.5, Vec3(1, 0, 1), "a")};
  s.floats[0].body.triangles.pop_back();
  EXPECT_NE(fault(s).find("its surface is open"), std::string::npos);
  s.floats = {floating_ball(0.2, 0.5, Vec3(1, 0, 1), "a")};
  s.floats[0].body.mass.mass = 0;
  EXPECT_NE(fault(s).find("mass = 0 kg"), std::string::npos);
}

}  // namespace
}  // namespace ft

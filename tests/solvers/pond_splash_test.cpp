// Skins that dive and wade, what they throw up, and the account of all the water.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/solvers/pond_scenes.h"

namespace ft {
namespace {

const bool k_show = std::getenv("POND_SHOW") != nullptr;

/// A capsule of 75 kg, upright, that goes in from 10 m: its centre's height by time since its nose touched, as drag of
/// that length stops it.
struct Diver {
  static constexpr double k_speed = 14.007, k_length = 2.8, k_radius = 0.12, k_tall = 1.8;
  TriangleSurface skin = capsule_surface(k_radius, k_tall - 2 * k_radius, 3);
  Vec3 place;
  static double depth(double t) { return t < 0 ? k_speed * t : k_length * std::log(1 + k_speed * t / k_length); }
  std::vector<Vec3> at(double t) const {
    std::vector<Vec3> out = skin.positions;
    for (Vec3& p : out) p += place + Vec3(0, 0.5 * k_tall - depth(t), 0);
    return out;
  }
};

struct Dive {
  std::unique_ptr<PondSolver> pond;
  State state;
  Diver diver;
  double start = -0.1, fps = 24;
  PondReport advance() {
    const double t = start + state.time;
    const auto from = diver.at(t), to = diver.at(t + 1 / fps);
    const DrivenBody body{diver.skin.triangles, from, to};
    return pond->advance_frame(state, 1 / fps, {&body, 1});
  }
  double time() const { return start + state.time; }
};

Dive dive() {
  PondSetup s = square_pond(16, 128, 5);
  s.corner = Vec3(-1, 2, 3);
  Dive out;
  out.pond = made(s);
  out.state = out.pond->initial_state();
  out.diver.place = s.corner + Vec3(8.03, 0, 7.96);
  return out;
}

TEST(PondSplash, A_diver_goes_in_at_the_speed_of_ten_metres_and_slows_as_drag_of_its_length) {
  Dive d = dive();
  d.fps = 96;
  while (d.time() < 0.6) {
    const double middle = d.time() + 0.5 / d.fps;
    const PondReport r = d.advance();
    if (middle < 0.5 / d.fps) continue;
    const double v = Diver::k_speed / (1 + Diver::k_speed * middle / Diver::k_length);
    ASSERT_NEAR(r.driven[0].speed, v, 0.01 * v);
  }
}

TEST(PondSplash, A_dive_throws_a_crown_leaves_a_cavity_and_its_water_comes_back) {
  Dive d = dive();
  double highest = 0, opened = -1, closed = -1, tail_in = -1, worst = 0, least_cavity = 0, thrown = 0;
  const double before = d.pond->ledger(d.state).total();
  int landed = 0, launched = 0;
  double t = 0, most_foam = 0;
  std::vector<double> foam(at(d.pond->nx() * d.pond->nz()));
  while (d.time() < 3) {
    const PondReport r = d.advance();
    t = d.time();
    ASSERT_TRUE(r.finite);
    worst = std::max(worst, std::abs(r.ledger.total() - before) / before);
    least_cavity = std::min(least_cavity, r.ledger.cavities);
    if (tail_in < 0 && Diver::depth(t) > Diver::k_tall) tail_in = t;
    if (opened < 0 && r.ledger.cavities < 0) opened = t;
    if (closed < 0 && (*d.state.find("driven"))[2] != 0) closed = t;
    double frame_high = 0;
    for (const Droplet& p : d.pond->droplets(d.state)) frame_high = std::max(frame_high, p.place.y() - 2);
    highest = std::max(highest, frame_high);
    launched += r.thrown, landed += r.landed;
    thrown = std::max(thrown, r.ledger.droplets);
    d.pond->foam(d.state, foam);
    most_foam = std::max(most_foam, *std::max_element(foam.begin(), foam.end()));
  }
  if (k_show)
    std::printf(
        "crown %.2f m, tail in %.3f, cavity %.3f, closed %.3f s, %.1f L of air, %.1f L thrown, %d droplets, energy "
        "%.0f J, ledger %.2g, foam %.2f\n",
        highest, tail_in, opened, closed, -1000 * least_cavity, 1000 * thrown, launched, d.pond->energy(d.state).thrown,
        worst, most_foam);
  EXPECT_GT(highest, 1);
  EXPECT_LT(highest, 4);
  // The tail's own instant, not the frame's.
  const double tail = Diver::k_length / Diver::k_speed * (std::exp(Diver::k_tall / Diver::k_length) - 1);
  EXPECT_GT(closed - tail, 0.12);
  EXPECT_LT(closed - tail, 0.3);
  EXPECT_LT(least_cavity, -0.005);
  EXPECT_GT(launched, 100);
  EXPECT_EQ(landed, launched);
  EXPECT_GT(most_foam, 0.1);
  EXPECT_LT(worst, 1e-12);
  EXPECT_EQ(d.pond->ledger(d.state).droplets, 0);
  // Pool and capsule: all the air is out again.
  EXPECT_NEAR(d.pond->ledger(d.state).cavities, 0, 1e-15);
}

// Against the volume that moved, not the pool's: 1e-12 of the latter would be loose.
TEST(PondSplash, What_a_skin_displaces_rises_elsewhere_and_falls_back) {
  PondSetup s = square_pond(4, 64, 2);
  s.splash.on = false;
  const auto pond = made(s);
  State state = pond->initial_state();
  const TriangleSurface box = box_surface(Vec3(0.5, 0.6, 0.4));
  const auto at_height = [&](double y) {
    std::vector<Vec3> out = box.positions;
    for (Vec3& p : out) p += Vec3(1.9, y, 2.1);
    return out;
  };
  double y = 0.5, submerged = 0;
  for (int f = 0; f < 24; ++f) {
    const auto from = at_height(y), to = at_height(y - 0.04);
    const DrivenBody body{box.triangles, from, to};
    const PondReport r = pond->advance_frame(state, 1.0 / 24, {&body, 1});
    y -= 0.04, submerged = r.driven[0].submerged;
  }
  EXPECT_NEAR(submerged, 0.5 * 0.6 * 0.4, 0.03 * 0.12);
  EXPECT_NEAR((*state.find("eta"))[0] * 16, submerged, 1e-14);
  for (int f = 0; f < 24; ++f) {
    const auto from = at_height(y), to = at_height(y + 0.04);
    const DrivenBody body{box.triangles, from, to};
    pond->advance_frame(state, 1.0 / 24, {&body, 1});
    y += 0.04;
  }
  EXPECT_NEAR((*state.find("eta"))[0] * 16, 0, 1e-14);
}

/// A post of 0.5 x 0.5 m and 1 m deep that is drawn through the water.
PondReport drawn(double speed, double seconds, State& state, const PondSolver& pond) {
  const TriangleSurface post = box_surface(Vec3(0.5, 2, 0.5));
  PondReport r;
  const double start = state.time;
  while (state.time < start + seconds - 1e-9) {
    const auto at_time = [&](double t) {
      std::vector<Vec3> out = post.positions;
      for (Vec3& p : out) p += Vec3(2 + speed * t, 0, 4);
      return out;
    };
    const auto from = at_time(state.time), to = at_time(state.time + 1.0 / 24);
    const DrivenBody body{post.triangles, from, to};
    r = pond.advance_frame(state, 1.0 / 24, {&body, 1});
  }
  return r;
}

TEST(PondSplash, What_wades_makes_waves_and_what_stands_makes_none) {
  const auto pond = made(square_pond(8, 64, 2));
  State moving = pond->initial_state(), still = moving;
  const PondReport walked = drawn(1.2, 2, moving, *pond), stood = drawn(0, 2, still, *pond);
  EXPECT_LT(stood.energy.waves, 1e-20);  // rounding
  EXPECT_GT(walked.energy.waves, 1);
  EXPECT_GT(walked.highest, 0.01);
  EXPECT_LT(walked.driven[0].mean.force.x(), -50);
  EXPECT_FALSE(walked.dry);
}

TEST(PondSplash, A_skin_pushes_a_ball_ahead_and_feels_it) {
  PondSetup s = square_pond(8, 64, 2);
  s.floats.push_back(floating_ball(0.3, 0.5, Vec3(2.8, 0, 4)));
  const auto pond = made(s);
  State state = pond->initial_state();
  // Its triangles are large: the ball meets vertices only, so a fine sphere is the skin.
  const TriangleSurface skin = sphere_surface(0.4, 4);
  double pushed = 0;
  for (int f = 0; f < 36; ++f) {
    const auto at_time = [&](double t) {
      std::vector<Vec3> out = skin.positions;
      for (Vec3& p : out) p += Vec3(2 + 1.5 * t, 0, 4);
      return out;
    };
    const auto from = at_time(state.time), to = at_time(state.time + 1.0 / 24);
    const DrivenBody body{skin.triangles, from, to};
    const PondReport r = pond->advance_frame(state, 1.0 / 24, {&body, 1});
    pushed += r.skin_pushes[0].x();
    const double gap = (pond->float_motions(state)[0].pose.position - Vec3(2 + 1.5 * state.time, 0, 4)).norm();
    EXPECT_GT(gap, 0.7 - 0.04);
  }
  EXPECT_GT(pond->float_motions(state)[0].pose.position.x(), 4);
  EXPECT_LT(pushed, -10);
}

TEST(PondSplash, A_box_held_under_weighs_less_by_the_water_it_displaces) {
  PondSetup s = square_pond(4, 64, 2);
  s.corner = Vec3(3, -1, 2);
  const auto pond = made(s);
  State state = pond->initial_state();
  const TriangleSurface box = box_surface(Vec3(0.5, 0.6, 0.4));
  std::vector<Vec3> still = box.positions;
  for (Vec3& p : still) p += s.corner + Vec3(2, -0.8, 2);
  const DrivenBody body{box.triangles, still, still};
  const PondReport r = pond->advance_frame(state, 1.0 / 24, {&body, 1});
  EXPECT_NEAR(r.driven[0].mean.force.y(), 1000 * 9.81 * 0.12, 1e-9 * 1177);
  const Vec3 about_box = r.driven[0].mean.moved(s.corner + Vec3(2, -0.8, 2)).torque;
  EXPECT_LT(about_box.norm(), 1e-8);
}

TEST(PondSplash, Dropped_balls_throw_water_that_comes_back_to_the_last_drop) {
  PondSetup s = square_pond(6, 64, 2);
  for (int i = 0; i < 3; ++i)
    s.floats.push_back(floating_ball(0.15, 0.3 + 0.6 * i, Vec3(1.6 + 1.2 * i, 1.5, 3), std::to_string(i)));
  const auto pond = made(s);
  State state = pond->initial_state();
  const double before = pond->ledger(state).total();
  double worst = 0, flying = 0;
  int thrown = 0, landed = 0;
  for (int f = 0; f < 72; ++f) {
    const PondReport r = pond->advance_frame(state, 1.0 / 24, {});
    worst = std::max(worst, std::abs(r.ledger.total() - before) / before);
    flying = std::max(flying, r.ledger.droplets);
    thrown += r.thrown, landed += r.landed;
  }
  if (k_show) std::printf("%.2f L flying, %d thrown, ledger %.2g\n", 1000 * flying, thrown, worst);
  EXPECT_LT(worst, 1e-12);
  EXPECT_GT(flying, 1e-4);
  EXPECT_EQ(thrown, landed);
}

}  // namespace
}  // namespace ft

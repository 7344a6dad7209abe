// Droplets and bodies: none goes in, none goes through, they run off and are carried along; the same in all waters.
#include <gtest/gtest.h>

#include <numbers>

#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "solvers/water/droplet_flight.h"
#include "solvers/water/droplet_numbers.h"
#include "tests/solvers/three_waters.h"

namespace ft {
namespace {

using namespace test;

constexpr double k_pi = std::numbers::pi;
/// Of a droplet on a body: what it falls within the skin before it is stopped again [m/s].
const double k_skin_speed = std::sqrt(2 * k_g * DropletBodies::k_skin);
const DropletAir k_vacuum{1.2, 0};

/// How far a place is outside of a convex surface: before the plane of one of its triangles [m].
double outside(const TriangleSurface& convex, const Vec3& in_body) {
  double most = -1e300;
  for (const Triangle& t : convex.triangles) {
    const Vec3 &a = convex.positions[at(t[0])], &b = convex.positions[at(t[1])], &c = convex.positions[at(t[2])];
    most = std::max(most, (in_body - a).dot((b - a).cross(c - a).normalized()));
  }
  return most;
}

double uniform(int n, std::uint64_t draw) {
  return random_uniform(RandomKey{7, 0, 0, static_cast<std::uint64_t>(n)}, draw);
}

Droplet droplet(const Vec3& place, const Vec3& velocity = Vec3::Zero(), std::uint64_t id = 1) {
  return {id, place, velocity, 1e-7};
}

/// Flies for a time in steps among one driven body; after each step calls look(time).
template <class Look>
void fly_among(std::vector<Droplet>& droplets, Driven& body, double friction, double frame, int steps, double time,
               Look&& look) {
  for (int f = 0; f < static_cast<int>(std::lround(time / frame)); ++f) {
    const DrivenBody driven = body.frame(f * frame, (f + 1) * frame);
    DropletBodies met({&driven, 1}, {}, Vec3::Zero(), friction);
    for (int n = 0; n < steps; ++n) {
      met.set_step(double(n) / steps, double(n + 1) / steps);
      fly(droplets, k_vacuum, k_g, 1000, frame / steps, met);
      look((f + double(n + 1) / steps) * frame);
    }
  }
}

TEST(DropletBodies, A_stream_on_a_ball_runs_off_it_and_none_is_ever_inside) {
  Driven ball{sphere_surface(0.5, 3), [](double) -> Vec3 { return Vec3::Zero(); }, {}, {}};
  std::vector<Droplet> droplets;
  double volume = 0;
  for (int n = 0; n < 600; ++n) {
    const double r = 0.05 + 0.44 * uniform(n, 0), turn = 2 * k_pi * uniform(n, 1);
    droplets.push_back(droplet(Vec3(r * std::cos(turn), 0.6 + uniform(n, 2), r * std::sin(turn)),
                               Vec3(0, -10 * uniform(n, 3), 0), static_cast<std::uint64_t>(n)));
    volume += droplets.back().volume;
  }
  double innermost = 1;
  int steps = 0;
  fly_among(droplets, ball, 0, 1.0 / 24, 3, 4, [&](double) {
    if (++steps % 4 != 0) return;
    for (const Droplet& d : droplets) innermost = std::min(innermost, outside(ball.surface, d.place));
  });
  EXPECT_GE(innermost, 0);
  double after = 0;
  for (std::size_t n = 0; n < droplets.size(); ++n) {
    EXPECT_LT(droplets[n].place.y(), -0.5) << "all of them run off";
    EXPECT_GT(Vec2(droplets[n].place.x(), droplets[n].place.z()).norm(), 0.5 * std::sin(std::acos(2.0 / 3)))
        << "a point without friction leaves a ball at 2/3 of its radius above the middle, or where it met it further "
           "out";
    EXPECT_GT(Vec2(droplets[n].velocity.x(), droplets[n].velocity.z()).norm(), 0) << "it has met the ball";
    EXPECT_EQ(droplets[n].id, n);
    after += droplets[n].volume;
  }
  EXPECT_EQ(after, volume);
}

TEST(DropletBodies, On_a_slope_they_go_as_weight_and_friction_say_whatever_the_steps) {
  const double slope = 0.5, friction = 0.2;
  Driven plate{box_surface(Vec3(20, 0.002, 1)), [](double) -> Vec3 { return Vec3::Zero(); }, {}, {}};
  const Mat3 turn = Eigen::AngleAxisd(slope, Vec3::UnitZ()).toRotationMatrix();
  for (Vec3& p : plate.surface.positions) p = turn * p;
  const Vec3 down = turn * Vec3(-1, 0, 0), normal = turn * Vec3::UnitY();
  for (const int steps : {1, 7, 50}) {
    std::vector<Droplet> one{droplet(Vec3(3, 2.5, 0.03))};
    fly_among(one, plate, friction, 1.0 / 24, steps, 1, [](double) {});
    // From rest: what it had along the slope when it fell, less friction times what it lost against it, and so on.
    EXPECT_NEAR(one[0].velocity.dot(down), (std::sin(slope) - friction * std::cos(slope)) * k_g, 2 * k_skin_speed);
    EXPECT_NEAR(one[0].velocity.dot(normal), 0, k_skin_speed);
    EXPECT_NEAR(one[0].place.dot(normal), 0.001, 2 * DropletBodies::k_skin);
  }
}

TEST(DropletBodies, A_plate_that_moves_takes_them_along_and_a_fast_one_is_not_passed) {
  const double friction = 0.25, speed = 1.5;
  Driven plate{box_surface(Vec3(20, 0.01, 20)), [&](double t) -> Vec3 { return Vec3(speed * t, 0, 0); }, {}, {}};
  std::vector<Droplet> one{droplet(Vec3(0, 0.005 + 1e-7, 0))};
  fly_among(one, plate, friction, 1.0 / 24, 5, 1, [&](double t) {
    EXPECT_NEAR(one[0].velocity.x(), std::min(speed, friction * k_g * t), 2 * friction * k_skin_speed) << t;
  });
  EXPECT_NEAR(one[0].velocity.x(), speed, 1e-9);
  // Thin, and 30 m/s upwards against what rains at 20 m/s: a step is 2 m.
  Driven fast{box_surface(Vec3(20, 0.001, 20)), [&](double t) -> Vec3 { return Vec3(0, -9 + 30 * t, 0); }, {}, {}};
  std::vector<Droplet> rain;
  for (int n = 0; n < 300; ++n)
    rain.push_back(droplet(Vec3(4 * uniform(n, 0), 5 * uniform(n, 1), 4 * uniform(n, 2)), Vec3(0, -20, 0)));
  fly_among(rain, fast, friction, 1.0 / 24, 1, 1, [&](double t) {
    for (const Droplet& d : rain) ASSERT_GT(d.place.y(), fast.place(t).y() + 0.0005) << t;
  });
  for (const Droplet& d : rain) EXPECT_NEAR(d.velocity.y(), 30, 1e-9);
}

TEST(DropletBodies, A_valley_and_a_closing_gap_hold_them) {
  // Two slopes that meet, and a third that closes the valley's end; towards it the valley falls.
  Driven valley;
  valley.place = [](double) -> Vec3 { return Vec3::Zero(); };
  for (const double side : {-1.0, 1.0}) {
    TriangleSurface wall = box_surface(Vec3(4, 0.1, 4));
    const Mat3 turn =
        (Eigen::AngleAxisd(0.2, Vec3::UnitZ()) * Eigen::AngleAxisd(0.9 * side, Vec3::UnitX())).toRotationMatrix();
    const int first = static_cast<int>(valley.surface.positions.size());
    for (const Vec3& p : wall.positions) valley.surface.positions.push_back(turn * (p + Vec3(0, -0.05, -1.8 * side)));
    for (const Triangle& t : wall.triangles)
      valley.surface.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  const Vec3 along = Eigen::AngleAxisd(0.2, Vec3::UnitZ()) * Vec3(-1, 0, 0);
  std::vector<Droplet> droplets;
  for (int n = 0; n < 40; ++n) droplets.push_back(droplet(Vec3(0.5 * uniform(n, 0), 0.8, 0.4 * (uniform(n, 1) - 0.5))));
  fly_among(droplets, valley, 0, 1.0 / 24, 4, 0.75, [](double) {});
  for (const Droplet& d : droplets) {
    EXPECT_GT(d.place.y(), -1.2 * std::sin(0.2) - 0.5) << "it has not fallen through";
    EXPECT_GT(d.velocity.dot(along), 0);
  }
  // A press whose jaws meet: what is between them stays between them as long as there is room.
  Driven press;
  std::vector<Droplet> pressed{droplet(Vec3(0.01, 0.1, 0.02))};
  const TriangleSurface jaw = box_surface(Vec3(2, 0.1, 2));
  for (int f = 0; f < 24; ++f) {
    const auto gap = [](double t) { return 0.2 - 0.19 * t; };
    std::vector<Vec3> from[2], to[2];
    for (const Vec3& p : jaw.positions) {
      from[0].push_back(p - Vec3(0, 0.05, 0)), to[0].push_back(p - Vec3(0, 0.05, 0));
      from[1].push_back(p + Vec3(0, 0.05 + gap(f / 24.0), 0)),
          to[1].push_back(p + Vec3(0, 0.05 + gap((f + 1) / 24.0), 0));
    }
    const DrivenBody both[2] = {{jaw.triangles, from[0], to[0]}, {jaw.triangles, from[1], to[1]}};
    DropletBodies met(both, {});
    met.set_step(0, 1);
    fly(pressed, k_vacuum, k_g, 1000, 1.0 / 24, met);
    EXPECT_GT(pressed[0].place.y(), 0);
    EXPECT_LT(pressed[0].place.y(), gap((f + 1) / 24.0));
  }
}

TEST(DropletBodies, What_begins_inside_flies_out) {
  Driven ball{sphere_surface(0.5, 3), [](double) -> Vec3 { return Vec3::Zero(); }, {}, {}};
  std::vector<Droplet> one{droplet(Vec3(0.1, 0, 0), Vec3(5, 0, 0))}, free = one;
  fly_among(one, ball, 0.1, 1.0 / 24, 2, 0.25, [](double) {});
  Driven far{sphere_surface(0.5, 3), [](double) -> Vec3 { return Vec3(50, 0, 0); }, {}, {}};
  fly_among(free, far, 0.1, 1.0 / 24, 2, 0.25, [](double) {});
  EXPECT_EQ(one[0].place, free[0].place) << "to the bit, as if there were no ball";
}

class Waters : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Waters, testing::Values("shallow", "pond", "paper"),
                         [](const auto& p) { return std::string(p.param); });

TEST_P(Waters, What_rains_on_a_floating_box_stays_on_it_and_no_water_is_lost) {
  const TriangleSurface hull = box_surface(Vec3(1, 0.3, 1));
  const double height = 0.075;  // of its middle, at half the water's density: at rest 0
  auto water = water_of(GetParam(), {floating("box", hull, 500, Vec3(0, height, 0), 1)}, 0.5, false);
  State state = water->initial_state();
  std::vector<Droplet> rain;
  for (int n = 0; n < 400; ++n)
    rain.push_back({static_cast<std::uint64_t>(n) + 1,
                    Vec3(0.9 * (uniform(n, 0) - 0.5), 0.5 + uniform(n, 1), 0.9 * (uniform(n, 2) - 0.5)), Vec3(0, -3, 0),
                    1e-8});
  for (Droplet& d : rain) d.place += middle_of(GetParam());
  state.set("droplets", write_droplets(rain));
  const double all = water->ledger(state).total();
  double innermost = 1;
  for (int f = 0; f < 36; ++f) {
    water->advance(state, 1 / 24.0, {});
    const RigidPose pose = water->floating(state)[0].pose;
    for (const Droplet& d : water->droplets(state))
      innermost = std::min(innermost, outside(hull, pose.rotation.conjugate() * (d.place - pose.position)));
    ASSERT_NEAR(water->ledger(state).total(), all, 1e-12 * all) << f;
  }
  EXPECT_GE(innermost, 0);
  const RigidPose pose = water->floating(state)[0].pose;
  int on_deck = 0;
  for (const Droplet& d : water->droplets(state)) {
    const Vec3 in_body = pose.rotation.conjugate() * (d.place - pose.position);
    on_deck += std::abs(in_body.y() - 0.15) < 2e-3 ? 1 : 0;
  }
  EXPECT_GT(on_deck, 300);
}

TEST_P(Waters, What_splashes_under_a_lid_stays_under_it) {
  // A slab comes down at 4 m/s and a fountain rises at as much beside it, under a lid that is wider than the water.
  const double under = 0.25;
  const auto highest = [&](bool lid, int threads, Hash128& bytes) {
    const ThreadLimit limit(threads);
    auto water = water_of(GetParam(), {}, 0.1, true);
    State state = water->initial_state();
    std::vector<Droplet> fountain;
    for (int n = 0; n < 100; ++n)
      fountain.push_back({static_cast<std::uint64_t>(n) + 1,
                          middle_of(GetParam()) + Vec3(0.6, 0.01, 0.1 * uniform(n, 0)), Vec3(0, 3 + uniform(n, 1), 0),
                          1e-7});
    state.set("droplets", write_droplets(fountain));
    const double all = water->ledger(state).total();
    Driven slab{box_surface(Vec3(0.4, 0.04, 0.4)),
                [](double t) -> Vec3 { return Vec3(0, std::max(0.1 - 4 * t, -0.075), 0); },
                {},
                {}};
    Driven roof{box_surface(Vec3(6, 0.02, 6)), [&](double) -> Vec3 { return Vec3(0, under + 0.01, 0); }, {}, {}};
    double out = 0;
    for (int f = 0; f < 24; ++f) {
      const DrivenBody bodies[2] = {slab.frame(f / 24.0, (f + 1) / 24.0), roof.frame(0, 0)};
      const WaterReport r = water->advance(state, 1 / 24.0, std::span(bodies).first(lid ? 2 : 1));
      for (const Droplet& d : water->droplets(state)) out = std::max(out, d.place.y());
      EXPECT_NEAR(r.ledger.total(), all, 1e-12 * all);
    }
    bytes = hash(state);
    return out;
  };
  Hash128 open, one, two;
  EXPECT_GT(highest(false, 2, open), under + 0.1) << "else the lid has nothing to do";
  const double lidded = highest(true, 1, one);
  EXPECT_LE(lidded, under);
  EXPECT_GT(lidded, under - 0.1);
  highest(true, 2, two);
  EXPECT_TRUE(one == two);
}

}  // namespace
}  // namespace ft

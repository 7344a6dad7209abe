// Hair on a head: it stands as it is combed, keeps its length, stays outside, and comes back.
#include "baker/core/parallel.h"
#include "tests/solvers/hair_scenes.h"

namespace ft {
namespace {

using namespace test;

double farthest(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  float squared = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squared = std::max(squared, (a[i] - b[i]).squaredNorm());
  return std::sqrt(static_cast<double>(squared));
}

/// Shakes to and fro along z by 5 cm, twice a second at speed 1, for so long [s].
Placing shake(double speed, double until) {
  return [=](double t) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    if (t > 0 && t < until) out.translation().z() = 0.05 * std::sin(4 * std::numbers::pi * speed * t);
    return out;
  };
}
/// Turns about an axis by this angle either way, once a second at speed 1.
Placing turn(const Vec3& axis, double angle, double speed, double until) {
  return [=](double t) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    if (t > 0 && t < until)
      out.linear() = Eigen::AngleAxisd(angle * std::sin(2 * std::numbers::pi * speed * t), axis).toRotationMatrix();
    return out;
  };
}

TEST(Hair, What_is_outside_of_a_sharp_tip_is_outside_however_its_triangles_lie_around_it) {
  // A thin cone with 24 slivers on the side of +x and +z, and three triangles on the rest.
  TriangleSurface cone;
  cone.positions = {Vec3(0, 0.1, 0), Vec3::Zero()};
  std::vector<double> angles;
  for (int k = 0; k < 24; ++k) angles.push_back(0.5 * std::numbers::pi * k / 24);
  for (int k = 0; k < 3; ++k) angles.push_back(0.5 * std::numbers::pi * (k + 1));
  for (const double a : angles) cone.positions.emplace_back(0.02 * std::cos(a), 0, -0.02 * std::sin(a));
  const int ring = static_cast<int>(angles.size());
  for (int k = 0; k < ring; ++k) {
    const int now = 2 + k, next = 2 + (k + 1) % ring;
    cone.triangles.push_back({0, now, next});
    cone.triangles.push_back({1, next, now});
  }
  const std::vector<HairBody> bodies{{"cone", rigid_body(cone, Vec3::Zero())}};
  const HairBodies all(bodies);
  std::vector<std::pair<int, int>> candidates;
  find_candidates(all, {Vec3::Constant(-1), Vec3::Constant(1)}, 0, candidates);
  ASSERT_EQ(candidates.size(), cone.triangles.size());
  for (int k = 0; k < 16; ++k) {
    const double a = std::numbers::pi / 8 * k;
    NearSurface near;
    const Vec3 outside = Vec3(0, 0.1, 0) + 0.005 * Vec3(0.9 * std::cos(a), 0.43, -0.9 * std::sin(a));
    ASSERT_EQ(find_nearest(all, candidates, outside, 0.02, 1, &near), 1);
    EXPECT_NEAR(near.gap, 0.005, 1e-4) << k;
    ASSERT_EQ(find_nearest(all, candidates, Vec3(1e-4 * std::cos(a), 0.07, 1e-4 * std::sin(a)), 0.02, 1, &near), 1);
    EXPECT_LT(near.gap, -0.003) << k;
  }
}

TEST(Hair, A_groom_stands_still) {
  const auto solver = solver_of(head_of_hair(60, 0.2, 24));
  State state = solver->initial_state();
  const std::vector<Vec3f> start = strands_of(*solver, state);
  FrameReport report;
  double drift = 0;
  for (int f = 0; f < 48; ++f) {
    report = solver->advance_frame(state);
    drift = std::max(drift, farthest(start, strands_of(*solver, state)));
  }
  printf("drift %.5f mm\n", 1e3 * drift);
  EXPECT_LT(drift, 0.0005);
  EXPECT_EQ(report.inside_body, 0);
  EXPECT_EQ(report.own.at("hair_unsettled"), 0);
}

TEST(Hair, Shaken_hair_keeps_its_length_stays_outside_and_comes_back) {
  for (const double speed : {1.0, 2.0, 4.0}) {
    const auto solver = solver_of(head_of_hair(60, 0.2, 24, shake(speed, 1)));
    State state = solver->initial_state();
    const std::vector<Vec3f> start = strands_of(*solver, state);
    double longest = 0, went = 0, unsettled = 0, iterations = 0;
    int inside = 0, segments = 0;
    for (int f = 0; f < 24 * 5; ++f) {
      const FrameReport report = solver->advance_frame(state);
      ASSERT_TRUE(report.finite);
      longest = std::max(longest, report.strain_max);
      inside += report.inside_body, segments += report.crossings_body;
      unsettled += report.own.at("hair_unsettled");
      iterations = std::max(iterations, report.own.at("hair_iterations"));
      went = std::max(went, farthest(start, strands_of(*solver, state)));
    }
    const double left = farthest(start, strands_of(*solver, state));
    printf("speed %.0f: went %.0f mm, left %.3f mm, longest %.5f, inside %d + %d, unsettled %.0f, iterations %.1f\n",
           speed, 1e3 * went, 1e3 * left, longest, inside, segments, unsettled, iterations);
    EXPECT_GT(went, 0.05);
    EXPECT_LT(longest, 0.001);
    EXPECT_EQ(inside, 0);
    EXPECT_EQ(segments, 0);
  }
}

TEST(Hair, Nods_and_turns_leave_no_strand_inside) {
  for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(1, 0, 0)})
    for (const double speed : {1.0, 2.0, 4.0}) {
      const auto solver = solver_of(head_of_hair(60, 0.2, 24, turn(axis, 0.7, speed, 1)));
      State state = solver->initial_state();
      int inside = 0, segments = 0;
      double longest = 0, unsettled = 0;
      for (int f = 0; f < 36; ++f) {
        const FrameReport report = solver->advance_frame(state);
        ASSERT_TRUE(report.finite);
        inside += report.inside_body, segments += report.crossings_body;
        longest = std::max(longest, report.strain_max);
        unsettled += report.own.at("hair_unsettled");
      }
      printf("axis %.0f %.0f, speed %.0f: inside %d + %d, longest %.5f, unsettled %.0f\n", axis.x(), axis.y(), speed,
             inside, segments, longest, unsettled);
      EXPECT_EQ(inside, 0);
      EXPECT_EQ(segments, 0);
      EXPECT_LT(longest, 0.001);
    }
}

TEST(Hair, What_falls_together_with_its_head_is_not_braked) {
  const Placing fall = [](double t) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.translation().y() = -0.5 * k_gravity * std::max(0.0, t) * std::max(0.0, t);
    return out;
  };
  // The same as without gravity and without a fall: combed under gravity, both straighten.
  std::vector<Vec3f> ends[2];
  double went = 0;
  for (const bool falls : {false, true}) {
    HairSetup setup = head_of_hair(20, 0.2, 24, falls ? fall : Placing());
    setup.bodies.clear();
    setup.material.air_drag = 0;
    setup.combed_gravity = setup.gravity;
    if (!falls) setup.gravity.setZero();
    const auto solver = solver_of(std::move(setup));
    State state = solver->initial_state();
    const std::vector<Vec3f> start = strands_of(*solver, state);
    for (int f = 0; f < 12; ++f) solver->advance_frame(state);
    ends[falls] = strands_of(*solver, state);
    if (!falls) went = farthest(start, ends[0]);
  }
  for (Vec3f& p : ends[1]) p.y() += static_cast<float>(0.5 * k_gravity * 0.25);
  printf("moved by %.1f mm, %.2f mm apart\n", 1e3 * went, 1e3 * farthest(ends[0], ends[1]));
  EXPECT_GT(went, 0.1);
  EXPECT_LT(farthest(ends[0], ends[1]), 0.003);
}

TEST(Hair, The_body_carries_the_weight_of_its_hair_and_what_it_takes_to_move_it) {
  const double lift = 3;  // m/s2
  const Placing rise = [&](double t) {
    return Eigen::Isometry3d(Eigen::Translation3d(0, 0.5 * lift * std::max(0.0, t) * std::max(0.0, t), 0));
  };
  for (const bool rises : {false, true}) {
    HairSetup setup = head_of_hair(20, 0.05, 12, rises ? rise : Placing());
    setup.hairs = 1e5;
    setup.material.air_drag = 0;
    setup.material.stiffness = 1000;  // a brush, which goes with its head at once
    const auto solver = solver_of(std::move(setup));
    const double length = 0.05, one = 1320 * std::numbers::pi * 40e-6 * 40e-6 * length;
    EXPECT_NEAR(solver->mass(), 1e5 * one, 0.06 * 1e5 * one);  // half a segment is the root's
    State state = solver->initial_state();
    Wrench mean;
    double frames = 0;
    for (int f = 0; f < 48; ++f) {
      const FrameReport report = solver->advance_frame(state);
      ASSERT_EQ(report.forces.size(), 1u);
      if (f >= 24) mean += report.forces[0].mean, ++frames;
    }
    const double expected = solver->mass() * (k_gravity + (rises ? lift : 0));
    printf("%.5f N, expected %.5f\n", -mean.force.y() / frames, expected);
    EXPECT_NEAR(-mean.force.y() / frames, expected, 0.005 * expected);
    EXPECT_LT(std::hypot(mean.force.x(), mean.force.z()) / frames, 0.005 * expected);
  }
}

TEST(Hair, Strands_are_carried_where_their_scalp_jumps) {
  const Placing jump = [](double t) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    if (t > 0.4) out = Eigen::Translation3d(2, 0, 1) * Eigen::AngleAxisd(1.5, Vec3::UnitY());
    return out;
  };
  HairSetup setup = head_of_hair(20, 0.2, 16, jump);
  setup.bodies.resize(1);
  setup.teleports = {11};  // of 24 frames a second, from 1 on: the first behind 0.4 s
  const auto solver = solver_of(setup);
  State state = solver->initial_state();
  const std::vector<Vec3f> start = strands_of(*solver, state);
  for (int f = 0; f < 24; ++f) EXPECT_TRUE(solver->advance_frame(state).finite);
  std::vector<Vec3f> wanted;
  for (const Vec3f& p : start) wanted.push_back((jump(1) * p.cast<double>()).cast<float>());
  EXPECT_LT(farthest(wanted, strands_of(*solver, state)), 1e-4);
}

TEST(Hair, One_thread_and_two_and_a_restored_state_have_the_same_bytes) {
  std::vector<Hash128> one, two;
  Bytes saved;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    const auto solver = solver_of(head_of_hair(30, 0.2, 16, shake(2, 1)));
    State state = solver->initial_state();
    for (int f = 0; f < 12; ++f) {
      solver->advance_frame(state);
      (threads == 1 ? one : two).push_back(hash(state));
      if (threads == 1 && f == 5) saved = save(state);
    }
  }
  EXPECT_TRUE(one == two);
  const auto solver = solver_of(head_of_hair(30, 0.2, 16, shake(2, 1)));
  auto state = load_state(saved);
  ASSERT_TRUE(state);
  for (std::size_t f = 6; f < 12; ++f) {
    solver->advance_frame(*state);
    ASSERT_TRUE(hash(*state) == one[f]) << f;
  }
}

/// Of each vertex, how many are within 20 mm of it.
std::vector<int> neighbours(const std::vector<Vec3f>& x) {
  std::vector<int> out(x.size(), 0);
  for (std::size_t a = 0; a < x.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if ((x[a] - x[b]).squaredNorm() < 0.02F * 0.02F) ++out[a], ++out[b];
  return out;
}

TEST(Hair, What_is_denser_than_combed_pushes_apart) {
  double crowded[2] = {0, 0};
  for (const bool pushes : {false, true}) {
    // The head leans to its side: all hangs down from there. Its scalp would lean into shoulders.
    HairSetup setup = head_of_hair(400, 0.2, 16, turn(Vec3(0, 0, 1), 1.4, 0.25, 2));
    setup.bodies.resize(1);
    if (!pushes) setup.material.pressure = 0;
    const auto solver = solver_of(setup);
    State state = solver->initial_state();
    const std::vector<int> combed = neighbours(strands_of(*solver, state));
    for (int f = 0; f < 36; ++f) {
      const FrameReport report = solver->advance_frame(state);
      EXPECT_EQ(report.inside_body, 0) << f;
      if (f % 6 != 5) continue;
      const std::vector<int> now = neighbours(strands_of(*solver, state));
      for (std::size_t k = 0; k < now.size(); ++k) crowded[pushes] += now[k] > 1.5 * (combed[k] + 2) ? 1 : 0;
    }
  }
  printf("vertices that are half as dense again as combed: %.0f, pushing %.0f\n", crowded[0], crowded[1]);
  EXPECT_GT(crowded[0], 100);
  EXPECT_LT(crowded[1], 0.85 * crowded[0]);
}

TEST(Hair, Cost_of_500_strands_of_32_slow) {
  const auto solver = solver_of(head_of_hair(500, 0.25, 32, shake(1, 2)));
  State state = solver->initial_state();
  double seconds = 0, iterations = 0;
  for (int f = 0; f < 24; ++f) {
    const FrameReport report = solver->advance_frame(state);
    seconds += report.profile.total / 24;
    iterations += report.own.at("hair_iterations") / 24;
  }
  printf("%.1f ms a frame, %.1f iterations\n", 1e3 * seconds, iterations);
  EXPECT_LT(seconds, 1.0);
}

}  // namespace
}  // namespace ft

// The basketball sample in its three couplings: what the paper says of them (O'Brien, Zordan & Hodgins 2000, section 3
// and the table of forces).
#include <gtest/gtest.h>

#include <algorithm>

#include "baker/core/equimomental.h"
#include "baker/plan/plan.h"
#include "baker/plan/prop.h"

namespace ft {
namespace {

constexpr const char* k_shot = FT_SOURCE_DIR "/samples/basketball/shot.toml";

Result<BakePlan> plan_of(std::vector<std::string> overrides) {
  ShotFaults faults;
  auto inputs = read_inputs(k_shot, overrides, {}, faults);
  if (!inputs) return inputs.error();
  const Importer none = [](const ImportRequest&) -> Result<ImportedPrimary> {
    return input_error("the sample imports nothing");
  };
  return make_plan(std::move(*inputs), none, {});
}

struct Outcome {
  Vec3 exit = Vec3::Zero();      ///< velocity of the ball at the end [m/s]
  double spin = 0;               ///< about z at the end [rad/s]
  double largest = 0, mean = 0;  ///< of the frames with contact [N]
  double strain = 0;             ///< largest of a cord
  int crossings = 0;
};

Outcome bake_of(const std::string& coupling) {
  Outcome out;
  auto plan = plan_of({"cords.net.coupling=" + coupling});
  EXPECT_TRUE(plan) << plan.error().text();
  auto solver = plan->groups.at(0)->make_solver();
  EXPECT_TRUE(solver) << solver.error().text();
  State state = (*solver)->initial_state();
  int touched = 0;
  while (state.frame < plan->shot().last_frame) {
    const FrameReport r = (*solver)->advance_frame(state);
    EXPECT_TRUE(r.finite);
    for (const Incident& i : r.incidents) EXPECT_NE(i.kind, Incident::Kind::k_unsettled) << r.frame << ": " << i.text;
    const double force = r.forces.at(0).mean.force.norm();
    out.largest = std::max(out.largest, force);
    if (r.forces[0].contact_share > 0) out.mean += force, ++touched;
    out.strain = std::max(out.strain, r.strain_max);
    out.crossings += r.crossings_body;
  }
  out.mean /= std::max(1, touched);
  const RigidMotion end = equimomental(plan->primaries[0].prop->mass)
                              .motion(as_points(*state.find("x")).last<4>(), as_points(*state.find("v")).last<4>());
  out.exit = end.velocity;
  out.spin = end.spin.z();
  return out;
}

TEST(Couplings, Ball_and_net_do_in_three_couplings_what_the_paper_says_of_them_slow) {
  const Outcome two_way = bake_of("two-way"), one_way = bake_of("one-way"), hybrid = bake_of("hybrid");
  for (const auto& [name, o] : {std::pair("two-way", two_way), {"one-way", one_way}, {"hybrid", hybrid}})
    std::printf("  %-8s exit %6.2f %6.2f m/s, spin %6.1f rad/s, force max %7.1f mean %6.1f N, strain %.4f\n", name,
                o.exit.x(), o.exit.y(), o.spin, o.largest, o.mean, o.strain);
  // Table: 59.9 N at most, 15.7 N on average; an order of magnitude for another net.
  EXPECT_GT(two_way.largest, 59.9 / 2);
  EXPECT_LT(two_way.largest, 59.9 * 2);
  EXPECT_GT(two_way.mean, 15.7 / 2);
  EXPECT_LT(two_way.mean, 15.7 * 2);
  // "The horizontal velocity reverses" in two-way only.
  EXPECT_LT(two_way.exit.x(), 0);
  EXPECT_GT(hybrid.exit.x(), 0);
  EXPECT_LT(two_way.exit.x(), hybrid.exit.x());
  EXPECT_LT(hybrid.exit.x(), one_way.exit.x());
  // "The net is forced to stretch a great deal" in one-way.
  EXPECT_GT(one_way.strain, 3 * two_way.strain);
  EXPECT_LT(hybrid.strain, one_way.strain);
  EXPECT_EQ(two_way.crossings, 0);
  EXPECT_EQ(hybrid.crossings, 0);
}

TEST(Couplings, A_one_way_ball_flies_ballistically) {
  auto plan = plan_of({"cords.net.coupling=one-way"});
  ASSERT_TRUE(plan) << plan.error().text();
  const PrimaryPlan& ball = plan->primaries[0];
  const PrimarySpec& spec = plan->shot().primaries[0];
  for (int frame = 0; frame <= 60; ++frame) {
    const double t = frame / plan->shot().fps;
    const Vec3 expected = spec.position + t * spec.velocity + 0.5 * t * t * plan->shot().solver.gravity;
    EXPECT_LT((ball.track(t).pose.position - expected).norm(), 1e-9);
    std::vector<Vec3> surface(at(ball.trajectory->surface().vertex_count()));
    ball.trajectory->sample(t, surface);
    Vec3 lo = surface[0], hi = surface[0];
    for (const Vec3& p : surface) lo = lo.cwiseMin(p), hi = hi.cwiseMax(p);
    EXPECT_LT((0.5 * (lo + hi) - expected).norm(), 2e-3 * *spec.radius);
    EXPECT_LT((ball.track(t).spin - spec.spin).norm(), 1e-12);
  }
}

TEST(Couplings, A_prop_keeps_its_velocity_until_it_is_released) {
  auto plan = plan_of({"cords.net.coupling=one-way", "primary.ball.release=13"});
  ASSERT_TRUE(plan) << plan.error().text();
  const PrimarySpec& spec = plan->shot().primaries[0];
  const double released = 12 / plan->shot().fps;
  const RigidTrack& track = plan->primaries[0].track;
  EXPECT_LT((track(released).pose.position - spec.position - released * spec.velocity).norm(), 1e-12);
  EXPECT_LT((track(-0.1).pose.position - spec.position).norm(), 1e-15);
  const double later = released + 0.2;
  EXPECT_LT(
      (track(later).pose.position - spec.position - later * spec.velocity - 0.5 * 0.04 * plan->shot().solver.gravity)
          .norm(),
      1e-12);
}

TEST(Couplings, What_cannot_be_baked_is_said) {
  const auto refused = [](std::vector<std::string> overrides) {
    auto plan = plan_of(std::move(overrides));
    EXPECT_FALSE(plan);
    return plan ? std::string() : plan.error().text();
  };
  EXPECT_NE(refused({"cords.net.coupling=two-way", "primary.ball.release=0"}).find("before the shot"),
            std::string::npos);
  EXPECT_NE(refused({"cords.net.mass=-1"}).find("mass"), std::string::npos);
}

}  // namespace
}  // namespace ft

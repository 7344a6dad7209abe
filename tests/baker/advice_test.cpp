// The decision tree and the pass that feeds it: the paper's own table gives the paper's choices, evidence follows
// closed forms, and neither depends on the frame rate.
#include "baker/judge/advice.h"

#include <gtest/gtest.h>

#include "baker/judge/advice_pass.h"
#include "tests/baker/fake_bake.h"

namespace ft {
namespace {

struct PaperRow {
  const char* primary;
  const char* secondary;
  double mass, force_max, force_mean;
  Coupling chosen;
};
// O'Brien, Zordan, Hodgins 2000, table of forces; the choices are those of the text.
constexpr PaperRow k_paper[] = {{"ball", "net", 0.68, 59.9, 15.7, Coupling::k_two_way},
                                {"gymnast", "trampoline", 64.38, 5298.8, 2215.2, Coupling::k_two_way},
                                {"alien", "vest", 46.56, 31.9, 6.9, Coupling::k_one_way},
                                {"alien", "noose", 46.56, 4055.3, 575.0, Coupling::k_two_way}};

Evidence evidence_of(double p95, double mean, double max) {
  Evidence e;
  e.primary = "body", e.secondary = "cloth";
  e.frames = 10;
  e.acceleration_p95 = p95, e.acceleration_mean = mean, e.acceleration_max = max;
  e.strain_p99 = 0.02;
  e.cycle_seconds = 5;
  return e;
}

std::string text(const Advice& advice) {
  std::string out;
  for (const std::string& reason : advice.reasons) out += reason + "\n";
  return out;
}

TEST(Advice, Gives_the_papers_choices_for_the_papers_table) {
  for (const PaperRow& row : k_paper) {
    const double max = row.force_max / row.mass;
    const Advice advice = advise(evidence_of(max, row.force_mean / row.mass, max), Context::k_none, {});
    EXPECT_EQ(advice.coupling, row.chosen) << row.primary << " and " << row.secondary << "\n" << text(advice);
    EXPECT_FALSE(advice.also) << row.secondary;
  }
}

TEST(Advice, Names_both_answers_between_insignificant_and_significant) {
  EXPECT_EQ(advise(evidence_of(0.5, 0.3, 0.6), Context::k_none, {}).coupling, Coupling::k_one_way);
  const Advice between = advise(evidence_of(2, 1, 3), Context::k_none, {});
  EXPECT_EQ(between.coupling, Coupling::k_two_way);
  EXPECT_EQ(between.also, Coupling::k_one_way);
  const Advice significant = advise(evidence_of(20, 10, 30), Context::k_none, {});
  EXPECT_EQ(significant.coupling, Coupling::k_two_way);
  EXPECT_FALSE(significant.also);
}

TEST(Advice, What_is_overwhelmed_or_hardly_moves_the_primary_is_insignificant) {
  Evidence e = evidence_of(2, 1, 3);
  e.own_acceleration = 25;
  EXPECT_EQ(advise(e, Context::k_none, {}).coupling, Coupling::k_one_way);
  e.own_acceleration = 15;
  EXPECT_EQ(advise(e, Context::k_none, {}).coupling, Coupling::k_two_way);
  e.displacement = 4e-3;
  EXPECT_EQ(advise(e, Context::k_none, {}).coupling, Coupling::k_one_way);
}

TEST(Advice, Context_makes_it_unimportant_and_a_hero_does_not) {
  const Evidence e = evidence_of(20, 10, 30);
  for (const char* name : {"background", "far", "occluded"})
    EXPECT_EQ(advise(e, context_from(name).value(), {}).coupling, Coupling::k_one_way) << name;
  EXPECT_EQ(advise(e, Context::k_hero, {}).coupling, Coupling::k_two_way);
  EXPECT_FALSE(context_from("nearby"));
}

TEST(Advice, One_way_that_is_unstable_becomes_hybrid) {
  for (int fault = 0; fault < 3; ++fault) {
    Evidence e = evidence_of(0.5, 0.3, 0.6);
    if (fault == 0) e.strain_p99 = 0.2;
    if (fault == 1) e.crossing_frames = 1;
    if (fault == 2) e.finite = false;
    const Advice advice = advise(e, Context::k_none, {});
    EXPECT_EQ(advice.coupling, Coupling::k_hybrid);
    EXPECT_NE(text(advice).find("unstable"), std::string::npos) << text(advice);
  }
}

TEST(Advice, A_debug_cycle_that_is_too_long_asks_for_a_stand_in_or_a_search) {
  Evidence e = evidence_of(20, 10, 30);
  e.cycle_seconds = 60;
  e.dissipative_share = 0.95, e.damping = 3.9, e.damping_r2 = 0.8;
  Advice advice = advise(e, Context::k_none, {});
  EXPECT_EQ(advice.coupling, Coupling::k_hybrid);
  EXPECT_NE(text(advice).find("c = 3.9 kg/s explains 80 % of it"), std::string::npos) << text(advice);
  e.dissipative_share = 0.5, e.upright_share = 0.95;
  advice = advise(e, Context::k_none, {});
  EXPECT_EQ(advice.coupling, Coupling::k_hybrid);
  EXPECT_NE(text(advice).find("vertical springs"), std::string::npos) << text(advice);
  e.upright_share = 0.5;
  advice = advise(e, Context::k_none, {});
  EXPECT_EQ(advice.coupling, Coupling::k_two_way);
  EXPECT_NE(text(advice).find("search"), std::string::npos) << text(advice);
}

TEST(Advice, Is_never_stricter_for_a_heavier_primary) {
  int strictest = 2;
  for (double mass = 0.5; mass < 1000; mass *= 1.3) {
    const Advice advice = advise(evidence_of(60 / mass, 16 / mass, 60 / mass), Context::k_none, {});
    const int now = advice.coupling == Coupling::k_one_way ? 0 : advice.also ? 1 : 2;
    EXPECT_LE(now, strictest) << mass;
    strictest = now;
  }
  EXPECT_EQ(strictest, 0);
}

TEST(Advice, Without_a_mass_says_what_is_missing) {
  Evidence e = evidence_of(0, 0, 0);
  e.mass_known = false;
  EXPECT_NE(text(advise(e, Context::k_none, {})).find("write mass"), std::string::npos);
}

/// A ball of 0.68 kg that a damping field of 3.9 kg/s slows from 4 m/s, sampled at frames: F = -c v.
Evidence damped_flight(double fps, double duration) {
  constexpr double k_mass = 0.68, k_damping = 3.9, k_speed = 4, k_rate = k_damping / k_mass;
  std::vector<Wrench> forces;
  std::vector<Vec3> centre;
  for (int i = 0; i <= static_cast<int>(std::lround(duration * fps)); ++i) {
    const double t = i / fps, before = (i - 1) / fps;
    centre.emplace_back(k_speed / k_rate * (1 - std::exp(-k_rate * t)), 0, 0);
    Wrench w;  // the mean over the frame that ends at t
    w.force.x() =
        i == 0 ? 0 : -k_damping * k_speed / k_rate * (std::exp(-k_rate * before) - std::exp(-k_rate * t)) * fps;
    forces.push_back(w);
  }
  Evidence e;
  gather(forces, centre, Vec3(0, -k_gravity, 0), k_mass, fps, e);
  return e;
}

TEST(AdviceEvidence, Finds_a_damping_field_and_the_change_of_velocity) {
  const Evidence e = damped_flight(240, 0.5);
  EXPECT_EQ(e.frames, 120);
  EXPECT_NEAR(e.damping, 3.9, 1e-9);
  EXPECT_NEAR(e.damping_r2, 1, 1e-9);
  EXPECT_EQ(e.dissipative_share, 1);
  EXPECT_EQ(e.upright_share, 0);
  EXPECT_NEAR(e.velocity_change.value(), 4 * (1 - std::exp(-3.9 / 0.68 * 0.5)), 1e-9);
}

TEST(AdviceEvidence, A_constant_force_moves_by_half_a_t_squared_in_half_a_second) {
  std::vector<Wrench> forces(100);
  for (Wrench& w : forces) w.force = Vec3(0, 6, 0);
  Evidence e;
  gather(forces, std::vector<Vec3>(100, Vec3::Zero()), Vec3(0, -k_gravity, 0), 3, 100, e);
  EXPECT_NEAR(e.displacement.value(), 0.5 * 2 * 0.25, 1e-12);
  EXPECT_NEAR(e.own_acceleration.value(), k_gravity, 1e-12);  // it stands: the ground carries it
  EXPECT_EQ(e.upright_share, 1);
  EXPECT_NEAR(e.acceleration_p95, 2, 1e-12);
}

TEST(AdviceEvidence, The_verdict_does_not_depend_on_the_frame_rate) {
  const Evidence slow = damped_flight(24, 0.5), fast = damped_flight(240, 0.5);
  EXPECT_NEAR(slow.acceleration_p95 / fast.acceleration_p95, 1, 0.15);
  EXPECT_NEAR(slow.displacement.value() / fast.displacement.value(), 1, 0.05);
  EXPECT_EQ(advise(slow, Context::k_none, {}).coupling, advise(fast, Context::k_none, {}).coupling);
}

TEST(AdviceEvidence, What_never_touches_and_what_has_no_mass_is_said) {
  Evidence e;
  gather(std::vector<Wrench>(5), std::vector<Vec3>(5, Vec3::Zero()), Vec3(0, -k_gravity, 0), 3, 24, e);
  EXPECT_EQ(e.frames, 0);
  EXPECT_FALSE(e.displacement);
  std::vector<Wrench> forces(5);
  for (Wrench& w : forces) w.force = Vec3(1, 0, 0);
  gather(forces, std::vector<Vec3>(5, Vec3::Zero()), Vec3(0, -k_gravity, 0), 0, 24, e);
  EXPECT_FALSE(e.mass_known);
  EXPECT_EQ(e.frames, 5);
  EXPECT_FALSE(e.displacement);
}

TEST(AdvicePass, Measures_every_garment_of_a_shot_and_keeps_to_its_time) {
  test::FakeScene scene;
  scene.write_shot(10);
  test::FakeBehaviour behaviour;
  behaviour.after_frame = [](int, FrameReport& report, State&) {
    InteractionForce f;
    f.system = "sheet";
    f.mean.force = Vec3(0, -5, 0);
    f.contact_share = 1;
    report.forces = {f};
    report.strain_p99 = 0.03;
  };
  AdviceOptions options;
  options.shot_file = scene.options().shot_file;
  options.overrides = {"primary.box.mass=2"};
  ShotFaults faults;
  auto pass = run_advice_pass(options, scene.services(behaviour), faults);
  ASSERT_TRUE(pass) << pass.error().text();
  ASSERT_EQ(pass->pairs.size(), 1u);
  EXPECT_EQ(pass->frames, 10);
  EXPECT_EQ(pass->shot_frames, 10);
  EXPECT_EQ(pass->pairs[0].secondary, "sheet");
  EXPECT_NEAR(pass->pairs[0].acceleration_mean, 2.5, 1e-12);
  EXPECT_EQ(pass->pairs[0].strain_p99, 0.03);
  Evidence stepped_together = pass->pairs[0];
  stepped_together.two_way_possible = true;
  EXPECT_EQ(advise(stepped_together, Context::k_none, {}).coupling, Coupling::k_two_way);
  const Json json = to_json(pass->pairs[0], advise(pass->pairs[0], Context::k_none, {}));
  EXPECT_EQ(json.at("coupling"), "hybrid");  // cloth is not stepped together with what wears it
  EXPECT_EQ(json.at("evidence").at("two_way_possible"), false);
  EXPECT_EQ(json.at("also"), "one-way");
  EXPECT_NEAR(json.at("evidence").at("effective_acceleration").at("mean").get<double>(), 2.5, 1e-12);
  options.seconds = 1e-9;
  pass = run_advice_pass(options, scene.services(behaviour), faults);
  ASSERT_TRUE(pass);
  EXPECT_EQ(pass->frames, 0);
  EXPECT_EQ(pass->pairs[0].frames, 0);
  bool said = false;
  for (const std::string& note : pass->notes)
    said = said || note.find("0 of 10 frames were measured") != std::string::npos;
  EXPECT_TRUE(said);
}

}  // namespace
}  // namespace ft

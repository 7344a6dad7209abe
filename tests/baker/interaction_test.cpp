// The table of forces: what it takes together, with which mass, and who is told.
#include "baker/run/interaction.h"

#include <gtest/gtest.h>

#include "baker/commands/compare_forces.h"
#include "baker/core/file.h"
#include "tests/baker/fake_bake.h"

namespace ft {
namespace {

InteractionForce force_of(const char* system, const Vec3& force, double peak, double share = 1) {
  InteractionForce out;
  out.system = system;
  out.mean = {force, Vec3(0, 0, 0.1 * force.norm())};
  out.peak = peak;
  out.contact_share = share;
  return out;
}

/// Two garments on one primary: in frame 1 neither touches, in 2 only the vest, in 3 both; frame 0 is pre-roll.
Manifest manifest_of_two() {
  Manifest m;
  m.fps = 10;
  m.first_written = 1;
  for (const char* name : {"vest", "belt"}) m.systems.push_back({name, "cloth", "runner", 4, 2, "", {}});
  m.frames.resize(4);
  for (int f = 0; f < 4; ++f) m.frames[at(f)].frame = f;
  m.frames[0].forces = {force_of("vest", {0, -1000, 0}, 1000), force_of("belt", {0, -1000, 0}, 1000)};
  m.frames[1].forces = {force_of("vest", {0, 0, 0}, 0, 0), force_of("belt", {0, 0, 0}, 0, 0)};
  m.frames[2].forces = {force_of("vest", {0, -4, 0}, 5), force_of("belt", {0, 0, 0}, 0, 0)};
  m.frames[3].forces = {force_of("vest", {0, -6, 0}, 9), force_of("belt", {8, 0, 0}, 8)};
  return m;
}

std::vector<PrimaryPlan> runner(double kilograms) {
  PrimaryPlan plan;
  plan.name = "runner";
  plan.mass = {kilograms, true, 0};
  return {plan};
}

TEST(Interaction, Takes_the_frames_with_contact_of_each_secondary_and_of_all_together) {
  const auto rows = interactions(manifest_of_two(), runner(50));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].secondary, "vest");
  EXPECT_EQ(rows[0].frames, 2);
  EXPECT_DOUBLE_EQ(rows[0].force.min, 4);
  EXPECT_DOUBLE_EQ(rows[0].force.mean, 5);
  EXPECT_DOUBLE_EQ(rows[0].force.max, 6);
  EXPECT_DOUBLE_EQ(rows[0].torque.max, 0.6);
  EXPECT_DOUBLE_EQ(rows[0].acceleration.mean, 0.1);
  EXPECT_DOUBLE_EQ(rows[0].peak, 9);
  EXPECT_NEAR(rows[0].impulse.y(), -1, 1e-12);
  EXPECT_EQ(rows[1].secondary, "belt");
  EXPECT_EQ(rows[1].frames, 1);
  EXPECT_EQ(rows[2].secondary, "");
  EXPECT_EQ(rows[2].frames, 2);
  EXPECT_DOUBLE_EQ(rows[2].force.max, 10);  // of the sum, not the sum of sizes
  EXPECT_DOUBLE_EQ(rows[2].peak, 17);
}

TEST(Interaction, Lines_name_the_mass_and_what_never_touched) {
  Manifest m = manifest_of_two();
  m.frames.resize(3);
  std::string all;
  for (const std::string& line : interaction_lines(interactions(m, runner(50)), runner(50))) all += line + "\n";
  EXPECT_NE(all.find("forces on \"runner\" (50 kg, as given)"), std::string::npos) << all;
  EXPECT_NE(all.find("a = 0.08 / 0.08 / 0.08 m/s2"), std::string::npos) << all;
  EXPECT_EQ(all.find("  belt"), std::string::npos) << all;
  EXPECT_NE(all.find("\"belt\" touches nothing in any frame"), std::string::npos) << all;
  m.frames.resize(2);
  EXPECT_EQ(interaction_lines(interactions(m, runner(50)), runner(50)).size(), 2u) << "neither touches anything";
}

TEST(Interaction, Has_a_row_for_each_primary_that_is_met) {
  Manifest m = manifest_of_two();
  std::vector<PrimaryPlan> both = runner(50);
  both.push_back(both[0]);
  both[1].name = "chair";
  for (FrameReport& frame : m.frames) {
    for (InteractionForce& f : frame.forces) f.primary = "runner";
    frame.forces.push_back(force_of("vest", {0, -20, 0}, 30, frame.frame == 3 ? 1 : 0));
    frame.forces.back().primary = "chair";
    frame.forces.push_back(force_of("belt", {0, 0, 0}, 0, 0));
    frame.forces.back().primary = "chair";
  }
  m.frames[3].forces[1].contact_share = 0;
  const auto rows = interactions(m, both);
  ASSERT_EQ(rows.size(), 6u);
  EXPECT_EQ(rows[0].primary, "runner");
  EXPECT_DOUBLE_EQ(rows[0].force.mean, 5);
  EXPECT_EQ(rows[3].primary, "chair");
  EXPECT_EQ(rows[3].secondary, "vest");
  EXPECT_EQ(rows[3].frames, 1);
  EXPECT_DOUBLE_EQ(rows[3].force.mean, 20);
  EXPECT_EQ(
      untouched_lines(rows),
      (std::vector<std::string>{"\"belt\" touches nothing in any frame: is it where \"runner\", \"chair\" are?"}));
  const auto compared = compare_forces(m, m);
  ASSERT_EQ(compared.size(), 2u) << "of the belt nothing touches";
  EXPECT_EQ(compared[1].primary == "chair" ? compared[1].max_a : compared[0].max_a, 20);
}

TEST(Interaction, Without_a_mass_there_is_no_acceleration_and_a_word_about_it) {
  const auto rows = interactions(manifest_of_two(), runner(0));
  EXPECT_EQ(rows[0].acceleration.max, 0);
  std::string all;
  for (const std::string& line : interaction_lines(rows, runner(0))) all += line + "\n";
  EXPECT_NE(all.find("mass unknown"), std::string::npos) << all;
  EXPECT_EQ(all.find("a ="), std::string::npos) << all;
  EXPECT_TRUE(to_json(rows, runner(0)).at("masses").at("runner").at("kilograms").is_null());
}

TEST(ForceComparison, Takes_the_frames_that_both_bakes_have) {
  const Manifest a = manifest_of_two();
  Manifest b = a;
  b.frames[3].forces[0].mean.force = Vec3(0, -6, 2);
  b.frames[3].forces[1].mean.force = Vec3(-8, 0, 0);
  b.systems.pop_back();
  auto forces = compare_forces(a, b);
  ASSERT_EQ(forces.size(), 2u);
  EXPECT_EQ(forces[0].system, "vest");
  ASSERT_EQ(forces[0].frames.size(), 2u);
  EXPECT_EQ(forces[0].frames[0].frame, 2);
  EXPECT_EQ(forces[0].frames[0].apart, 0);
  EXPECT_EQ(forces[0].worst, 1);
  EXPECT_DOUBLE_EQ(forces[0].frames[1].apart, 2);
  EXPECT_DOUBLE_EQ(forces[0].mean_a, 5);
  EXPECT_DOUBLE_EQ(forces[0].max_b, std::sqrt(40.0));
  EXPECT_DOUBLE_EQ(forces[1].frames[0].apart, 16);  // of the forces, not of their sizes
  EXPECT_NE(to_text(forces).find("force of vest: mean 5 N in a"), std::string::npos) << to_text(forces);
  EXPECT_EQ(to_json(forces).at(0).at("worst_frame"), 3);
  for (FrameReport& frame : b.frames) frame.forces.clear();
  EXPECT_TRUE(compare_forces(a, b).empty());
}

TEST(Interaction, Is_in_the_report_of_a_bake_and_in_what_is_said_at_its_end) {
  test::FakeScene scene;
  scene.write_shot(10);
  test::FakeBehaviour behaviour;
  behaviour.after_frame = [](int frame, FrameReport& report, State&) {
    report.forces = {force_of("sheet", {0, frame > 4 ? -3.0 : 0.0, 0}, 4, frame > 4 ? 1 : 0)};
  };
  test::RecordedProgress progress;
  BakeOptions options = scene.options();
  ASSERT_EQ(bake(options, scene.services(behaviour), progress).exit_code, 0);
  ASSERT_EQ(progress.last.details.size(), 2u);
  EXPECT_NE(progress.last.details[0].find("1010 kg, from its volume of 1"), std::string::npos)
      << progress.last.details[0];
  const auto report = parse_json(read_text(scene.folder().report()).value(), "report");
  ASSERT_TRUE(report);
  const Json& row = report->at("interaction").at("rows").at(0);
  EXPECT_TRUE(read_manifest(scene.folder().path)->notes.empty());
  EXPECT_EQ(row.at("secondary"), "sheet");
  EXPECT_EQ(row.at("frames"), 6);
  EXPECT_EQ(row.at("force").at("mean"), 3);
  EXPECT_NEAR(row.at("effective_acceleration").at("mean").get<double>(), 3 / 1010.0, 1e-5);
  options.force = true;
  options.overrides.push_back("primary.box.mass=60");
  ASSERT_EQ(bake(options, scene.services(behaviour), progress).exit_code, 0);
  EXPECT_NE(progress.last.details[0].find("(60 kg, as given)"), std::string::npos) << progress.last.details[0];
}

}  // namespace
}  // namespace ft

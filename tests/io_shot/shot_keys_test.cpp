#include "io/shot/shot_keys.h"

#include <set>

#include "tests/io_shot/shot_fixture.h"

namespace ft {
namespace {

TEST_F(ShotFile, Overrides_are_read_by_the_same_table) {
  const auto shot =
      parse(k_good, {"cloth.dress.fabric=denim", "wind.velocity=[1, 0, 2]", "shot.frames=1-20",
                     "primary.mannequin.clip=12", "cloth.cape.self_collision=false", "cloth.dress.mass_per_area=0.3",
                     "cloth.dress.bend_warp=1e-5", "cache.formats=mdd", "cloth.cape.pins=[{within=0.01}]"});
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(cloth_of(shot, 0).fabric, "denim");
  EXPECT_EQ(shot->wind.velocity, Vec3(1, 0, 2));
  EXPECT_EQ(shot->last_frame, 20);
  EXPECT_EQ(shot->primaries[0].clip, "12");
  EXPECT_FALSE(cloth_of(shot, 1).self_collision);
  EXPECT_EQ(cloth_of(shot, 0).fabric_overrides.size(), 2u);
  EXPECT_EQ(shot->cache_formats, std::vector<std::string>{"mdd"});
  EXPECT_EQ(cloth_of(shot, 1).pins.size(), 2u) << "pin and pins add up";
}

TEST_F(ShotFile, Faulty_overrides_name_themselves_as_their_place) {
  EXPECT_EQ(
      faults_of(k_good, {"cloth.dress.fabric=denm", "cloth.drss.fabric=denim", "foo.x=1", "cloth.dress=1", "fabric",
                         "=", "shot.fps=0", "cloth.dress.thickness=3mm", "gate.p99_strain=\n5"}),
      (std::vector<std::string>{
          "--set cloth.drss.fabric=denim: there is no cloth \"drss\" (did you mean \"dress\"?)",
          "--set foo.x=1: unknown section \"foo\" (known: shot, primary, cloth, cords, follow, leaves, hair, water, "
          "standin, "
          "wind, "
          "solver, cache, gate)",
          "--set cloth.dress=1: is not of the form cloth.NAME.key=value",
          "--set fabric: is not of the form section.key=value", "--set =: is not of the form section.key=value",
          "--set gate.p99_strain=?5: is not of the form section.key=value",
          "--set shot.fps=0: [shot]: fps = 0 is outside [1, 240] 1/s",
          "--set cloth.dress.fabric=denm: cloth \"dress\": fabric = \"denm\" is not known (did you mean \"denim\"?)",
          "--set cloth.dress.thickness=3mm: cloth \"dress\": thickness needs a number, not the text \"3mm\" (3mm is "
          "written 0.003)"}));
}

template <class Spec>
bool is_path(const ShotKey<Spec>& key) {
  return std::holds_alternative<std::filesystem::path Spec::*>(key.target);
}

// One changed value for every key of the table; a key that is added to the table without reaching a member fails here.
TEST_F(ShotFile, Every_key_of_the_table_can_be_set_and_changes_the_canonical_text) {
  const auto base = parse(k_good);
  ASSERT_TRUE(base.ok());
  const std::string before = canonical(*base);
  const std::set<std::string_view> texts = {"clip", "meshes", "ignore", "ignores"};
  std::set<std::string> seen = {before};
  int count = 0;
  const auto check = [&](const std::string& section, auto keys) {
    for (const auto& key : keys) {
      std::string value;
      if (key.name == "frames")
        value = "5-6";
      else if (key.name == "most")
        value = "{ kinetic_energy = 5 }";
      else if (key.name == "pins")
        value = "[{within=0.5}]";
      else if (key.name == "teleports")
        value = "[5, 7]";
      else if (key.name == "maps")
        value = "[{of=\"bend\",from=\"red\",low=1,high=2}]";
      else if (key.name == "pin")
        value = "elbow";
      else if (key.name == "formats")
        value = "[\"mdd\"]";
      else if (key.choices == "@fabrics")
        value = "silk";
      else if (key.choices.starts_with("@name of a primary") || key.name == "coupling")
        continue;  // need a second primary, a stand-in: tested elsewhere
      else if (!key.choices.empty())
        value = split_words(key.choices).back();
      else if (is_path(key))
        value = "walk.fbx";
      else if (texts.contains(key.name))
        value = "other";
      else if (key.name == "velocity" || key.name == "gravity" || key.name == "offset")
        value = "[0, 1, 2]";
      else if (key.lowest == 0 && key.highest == 0)
        value = key.name == "collider" || key.name == "self_collision" || key.name == "carve" ? "false" : "true";
      else
        value = key.highest >= 7 ? "7" : key.name == "thickness" ? "0.004" : "0.015";
      const auto shot = parse(k_good, {section + "." + std::string(key.name) + "=" + value});
      ASSERT_TRUE(shot.ok()) << section << " " << key.name << ": " << shot.error().text();
      EXPECT_TRUE(seen.insert(canonical(*shot)).second)
          << section << "." << key.name << " = " << value << " changes nothing";
      ++count;
    }
  };
  for_each_plain_section([&](std::string_view section, auto keys) { check(std::string(section), keys); });
  check("primary.mannequin", primary_keys());
  check("cloth.dress", cloth_keys());
  EXPECT_GT(count, 35);
}

TEST_F(ShotFile, Canonical_text_is_the_same_for_the_same_shot_written_differently) {
  const auto a = parse(k_good);
  std::string text = k_good;
  text.replace(text.find("fps = 25"), 8, "fps   =   25.0   # PAL");
  const auto b = parse(text);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(canonical(*a), canonical(*b));
}

TEST_F(ShotFile, Teleports_are_a_word_or_frames) {
  const auto shot = parse(k_good, {"primary.mannequin.teleports=[1041, 1003, 1041]"});
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(shot->primaries[0].teleports, Teleports::k_frames);
  EXPECT_EQ(shot->primaries[0].teleport_frames, (std::vector<int>{1003, 1041}));
  EXPECT_EQ(parse(k_good)->primaries[0].teleports, Teleports::k_detect);
  EXPECT_EQ(parse(k_good, {"primary.mannequin.teleports=ignore"})->primaries[0].teleports, Teleports::k_ignore);
  EXPECT_EQ(parse(k_good, {"primary.mannequin.teleports=1041"})->primaries[0].teleport_frames, std::vector<int>{1041});
  for (const char* wrong : {"detekt", "true", "[1.5]", "[-3]", "[\"1041\"]"})
    EXPECT_EQ(faults_of(k_good, {std::string("primary.mannequin.teleports=") + wrong}).size(), 1u) << wrong;
}

TEST_F(ShotFile, A_clip_loops_or_is_repeated_so_often) {
  EXPECT_FALSE(parse(k_good)->primaries[0].loop);
  EXPECT_TRUE(parse(k_good, {"primary.mannequin.loop=true"})->primaries[0].loop);
  const auto both = faults_of(k_good, {"primary.mannequin.loop=true", "primary.mannequin.repeat=3"});
  ASSERT_EQ(both.size(), 1u);
  EXPECT_NE(both[0].find("has both loop and repeat"), std::string::npos) << both[0];
}

TEST_F(ShotFile, Paths_of_settings_are_relative_to_the_shot_file) {
  const auto shot = parse(k_good);
  ASSERT_TRUE(shot.ok());
  EXPECT_EQ(canonical(*shot).find(folder_.path().string()), std::string::npos);
  EXPECT_NE(canonical(*shot).find("cloth.dress.mesh = \"dress.obj\"\n"), std::string::npos);
}

TEST_F(ShotFile, Changed_settings_are_told_by_key_and_both_values) {
  const auto before = parse(k_good);
  const auto now = parse(k_good, {"cloth.cape.fabric=denim", "cloth.cape.shear=50"});
  ASSERT_TRUE(before.ok() && now.ok());
  EXPECT_EQ(changed_settings(settings(*before), settings(*now)),
            (std::vector<std::string>{"cloth.cape.fabric changed from \"cotton\" to \"denim\"",
                                      "cloth.cape.shear is new (50)"}));
  EXPECT_EQ(changed_settings(settings(*now), settings(*before)),
            (std::vector<std::string>{"cloth.cape.fabric changed from \"denim\" to \"cotton\"",
                                      "cloth.cape.shear is gone (was 50)"}));
  EXPECT_TRUE(changed_settings(settings(*now), settings(*now)).empty());
}

TEST_F(ShotFile, Reference_names_every_key_with_its_range_and_unit) {
  const std::string reference = shot_file_reference(words());
  int count = 0;
  const auto check = [&](auto keys) {
    for (const auto& key : keys) {
      EXPECT_NE(reference.find("| `" + std::string(key.name) + "` |"), std::string::npos) << key.name;
      EXPECT_FALSE(key.meaning.empty()) << key.name;
      ++count;
    }
  };
  for_each_plain_section([&](std::string_view, auto keys) { check(keys); });
  check(primary_keys());
  check(cloth_keys());
  check(pin_keys());
  EXPECT_GT(count, 40);
  EXPECT_NE(reference.find("| `mass_per_area` | 0.02 to 2 kg/m2 |"), std::string::npos);
  EXPECT_NE(reference.find("`denim`"), std::string::npos);
}

TEST_F(ShotFile, Defaults_of_the_structs_lie_within_the_table) {
  const auto check = [](auto keys, const auto& spec) {
    for (const auto& key : keys) {
      if (key.lowest == 0 && key.highest == 0) continue;
      using Spec = std::decay_t<decltype(spec)>;
      double value = key.lowest;
      if (const auto* member = std::get_if<double Spec::*>(&key.target)) value = spec.**member;
      if (const auto* whole = std::get_if<int Spec::*>(&key.target)) value = spec.**whole;
      EXPECT_TRUE(value >= key.lowest && value <= key.highest) << key.name;
    }
  };
  const Shot shot;
  const PrimarySpec primary;
  const ClothSpec cloth;
  const PinSpec pin;
  check(shot_keys(), shot);
  check(cache_keys(), shot);
  check(gate_keys(), shot);
  check(wind_keys(), shot.wind);
  check(wind_field_keys(), WindKeys());
  check(solver_keys(), shot.solver);
  check(primary_keys(), primary);
  check(cloth_keys(), cloth);
  check(pin_keys(), pin);
}

}  // namespace
}  // namespace ft

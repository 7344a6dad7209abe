// Props, cords, stand-ins and couplings in the shot file.
#include <set>

#include "io/shot/shot_keys.h"
#include "tests/io_shot/shot_fixture.h"
#include "tests/support/damage.h"

namespace ft {
namespace {

const char* const k_basketball = R"([shot]
frames = "1-60"

[primary.ball]
shape = "sphere"
radius = 0.121
mass = 0.68
hollow = true
position = [-0.5, 0.9, 0]
velocity = [2, 1, 0]
spin = [0, 0, -6.28]

[cords.net]
shape = "net"
mass = 0.03
coupling = "two-way"

[standin.air]
kind = "damping"
shape = "cone"
radius_top = 0.225
radius_bottom = 0.12
height = 0.42
damping = 3.9
)";

class CordsShot : public ShotFile {
 protected:
  /// The shot with lines put in place of others; "" adds at the end.
  std::vector<std::string> faults_when(const std::vector<std::pair<std::string, std::string>>& changes,
                                       const std::vector<std::string>& overrides = {}) {
    std::string text = k_basketball;
    for (const auto& [old_text, new_text] : changes) {
      const std::size_t place = old_text.empty() ? text.size() : text.find(old_text);
      EXPECT_NE(place, std::string::npos) << old_text;
      text.replace(place, old_text.size(), new_text);
    }
    return faults_of(text, overrides);
  }
  void expect_fault(const std::vector<std::pair<std::string, std::string>>& changes, const std::string& fault) {
    EXPECT_EQ(faults_when(changes), std::vector<std::string>{fault});
  }
};

TEST_F(CordsShot, A_ball_and_a_net_are_read_with_their_defaults) {
  const auto shot = parse(k_basketball);
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  ASSERT_EQ(specs_of<CordsSpec>(shot->secondaries).size(), 1u);
  const CordsSpec& net = cords_of(shot, 0);
  EXPECT_EQ(net.on, "ball") << "the only primary";
  EXPECT_EQ(net.columns, 12);
  EXPECT_EQ(net.points, 2) << "of a net's side";
  EXPECT_EQ(net.coupling, "two-way");
  EXPECT_FALSE(net.self_collision);
  const PrimarySpec& ball = shot->primaries[0];
  EXPECT_EQ(ball.radius, 0.121);
  EXPECT_EQ(ball.velocity, Vec3(2, 1, 0));
  EXPECT_TRUE(ball.hollow);
  EXPECT_EQ(ball.release, Release::k_start);
  EXPECT_EQ(shot->standins[0].stands_for, "net") << "the only secondary";
  EXPECT_EQ(shot->standins[0].damping, 3.9);
}

TEST_F(CordsShot, One_shot_serves_all_three_couplings_and_says_what_it_does_not_use) {
  std::set<std::string> texts;
  for (const char* coupling : {"one-way", "hybrid", "two-way"}) {
    const auto shot = parse(k_basketball, {std::string("cords.net.coupling=") + coupling});
    ASSERT_TRUE(shot.ok()) << shot.error().text();
    EXPECT_EQ(cords_of(shot, 0).coupling, coupling);
    EXPECT_TRUE(texts.insert(canonical(*shot)).second);
    const std::string note =
        "standin \"air\" is not used: cords \"net\" has coupling = \"" + std::string(coupling) + "\"";
    EXPECT_EQ(shot->notes, coupling == std::string("hybrid") ? std::vector<std::string>() : std::vector{note});
  }
}

TEST_F(CordsShot, Cloth_may_be_hybrid_beside_cords_that_are_one_way) {
  std::string text = k_basketball;
  text += "for = \"cape\"\n[cloth.cape]\nmesh = \"dress.obj\"\ncoupling = \"hybrid\"\n";
  const auto shot = parse(text, {"cords.net.coupling=one-way"});
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(cloth_of(shot, 0).coupling, "hybrid");
  EXPECT_NE(canonical(*shot).find("cloth.cape.coupling = \"hybrid\"\n"), std::string::npos);
  EXPECT_TRUE(shot->notes.empty());
}

TEST_F(CordsShot, A_prop_is_released_at_once_at_a_frame_or_at_contact) {
  EXPECT_EQ(parse(k_basketball, {"primary.ball.release=contact"})->primaries[0].release, Release::k_contact);
  const auto shot = parse(k_basketball, {"primary.ball.release=12.5"});
  EXPECT_EQ(shot->primaries[0].release, Release::k_frame);
  EXPECT_EQ(shot->primaries[0].release_frame, 12.5);
  expect_fault(
      {{"frames = \"1-60\"", "frames = \"101-160\""}, {"hollow = true", "release = 100"}},
      "shot.toml:8:1: primary \"ball\": release = 100 is before the shot's first frame, 101 (without release it "
      "is free from there on)");
  expect_fault({{"hollow = true", "release = \"contcat\""}},
               "shot.toml:8:11: primary \"ball\": release needs a frame or \"contact\", not the text \"contcat\"");
  expect_fault({{"hollow = true", "release = -5"}},
               "shot.toml:8:11: primary \"ball\": release = -5 is outside [0, 9999999] frame");
}

TEST_F(CordsShot, A_primary_is_a_file_or_a_shape) {
  expect_fault(
      {{"shape = \"sphere\"\nradius = 0.121\n", ""},
       {"position = [-0.5, 0.9, 0]\nvelocity = [2, 1, 0]\nspin = [0, 0, -6.28]\n", ""},
       {"hollow = true\n", ""}},
      "shot.toml:4:1: primary \"ball\": file is missing (a character or geometry cache), or shape, for a rigid "
      "prop");
  expect_fault({{"hollow = true", "file = \"mannequin.glb\""}},
               "shot.toml:5:1: primary \"ball\": has both file and shape; a primary is one of them");
  expect_fault({{"hollow = true", "clip = \"Roll\""}},
               "shot.toml:8:1: primary \"ball\": clip goes with file, not with shape = \"sphere\"");
  expect_fault({{"hollow = true", "size = [1, 1, 1]"}},
               "shot.toml:8:1: primary \"ball\": size goes with shape = \"box\" or shape = \"ground\", not with shape "
               "= \"sphere\"");
  expect_fault({{"shape = \"sphere\"", "shape = \"capsule\""}},
               "shot.toml:4:1: primary \"ball\": length is missing; shape = \"capsule\" needs it");
  expect_fault({{"shape = \"sphere\"", "shape = \"spere\""}},
               "shot.toml:5:9: primary \"ball\": shape = \"spere\" is not known (did you mean \"sphere\"?)");
  expect_fault(
      {{"hollow = true", "inertia = [1, 1, 2.5]"}},
      "shot.toml:8:1: primary \"ball\": inertia is no body's: each moment is above 0 and at most the other two "
      "together");
  const auto file = parse(
      "[shot]\nframes = 1\n[primary.m]\nfile = \"walk.fbx\"\nmass = 2\ninertia = [1, 1, 1]\nrelease = "
      "\"contact\"\n[cords.c]\nshape = \"rope\"\nto = [0, 1, 0]\nmass = 1\ncoupling = \"two-way\"\n");
  EXPECT_TRUE(file.ok()) << "a prop from a file: " << file.error().text();
}

TEST_F(CordsShot, Two_way_needs_a_mass_and_is_not_for_cloth) {
  expect_fault({{"mass = 0.68\n", ""}},
               "shot.toml:4:10: primary \"ball\": mass is missing; the two-way coupling of cords \"net\" needs it");
  expect_fault({{"", "[cloth.cape]\nmesh = \"dress.obj\"\ncoupling = \"two-way\"\n"},
                {"damping = 3.9", "damping = 3.9\nfor = \"net\""}},
               "shot.toml:28:12: cloth \"cape\": coupling = \"two-way\" is for cords so far: cloth is not stepped "
               "together with a primary (hybrid or one-way is)");
  EXPECT_TRUE(
      faults_when({{"", "[cloth.cape]\nmesh = \"dress.obj\"\n"}, {"damping = 3.9", "damping = 3.9\nfor = \"net\""}})
          .empty())
      << "one-way beside two-way";
  expect_fault({{"", "[cloth.cape]\nmesh = \"dress.obj\"\ncoupling = \"hybrid\"\n"},
                {"damping = 3.9", "damping = 3.9\nfor = \"cape\""}},
               "shot.toml:16:12: cords \"net\": coupling = \"two-way\", and cloth \"cape\" on the same primary has "
               "\"hybrid\"; beside either, others are one-way");
}

TEST_F(CordsShot, Hybrid_needs_a_stand_in_of_its_own) {
  const std::pair<std::string, std::string> hybrid = {"coupling = \"two-way\"", "coupling = \"hybrid\""};
  expect_fault(
      {hybrid,
       {"[standin.air]\nkind = \"damping\"\nshape = \"cone\"\nradius_top = 0.225\nradius_bottom = 0.12\nheight = "
        "0.42\ndamping = 3.9\n",
        ""}},
      "shot.toml:16:12: cords \"net\": coupling = \"hybrid\" needs what the primary yields to: a [standin.NAME] "
      "with for = \"net\"");
  expect_fault({{"damping = 3.9", "damping = 3.9\nfor = \"nett\""}},
               "shot.toml:25:7: standin \"air\": for = \"nett\" names no secondary (did you mean \"net\"?)");
  expect_fault({{"", "[cloth.cape]\nmesh = \"dress.obj\"\n"}},
               "shot.toml:18:1: standin \"air\": for is missing; it says what it stands for (one of: cape, net)");
}

TEST_F(CordsShot, A_stand_in_may_be_on_a_primary_for_what_is_not_baked) {
  const std::string pool =
      "[shot]\nframes = 1\n[primary.diver]\nfile = \"walk.fbx\"\nlimbs = \"planted\"\n"
      "comeback = \"window\"\n[standin.pool]\nkind = \"water\"\n";
  const auto shot = parse(pool);
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(shot->standins[0].on, "diver") << "the only primary";
  EXPECT_NE(canonical(*shot).find("primary.diver.comeback = \"window\"\n"), std::string::npos);
  expect_fault({{"damping = 3.9", "damping = 3.9\non = \"ball\"\nfor = \"net\""}},
               "shot.toml:25:1: standin \"air\": has both for and on; on is for what no secondary is there for");
  expect_fault({{"damping = 3.9", "damping = 3.9\non = \"bal\""}},
               "shot.toml:25:6: standin \"air\": on = \"bal\" names no primary (did you mean \"ball\"?)");
  expect_fault({{"damping = 3.9", "damping = 3.9\non = \"ball\""}},
               "shot.toml:25:6: standin \"air\": primary \"ball\" is coupled two-way with cords \"net\", and cannot "
               "yield before it is baked as well");
  expect_fault({{"hollow = true", "limbs = \"planted\""}},
               "shot.toml:8:1: primary \"ball\": limbs goes with file, not with shape = \"sphere\"");
}

TEST_F(CordsShot, Shapes_and_kinds_say_which_keys_they_need_and_which_are_anothers) {
  expect_fault({{"shape = \"net\"", "shape = \"rope\""}},
               "shot.toml:13:1: cords \"net\": to is missing; shape = \"rope\" needs it");
  expect_fault(
      {{"mass = 0.03", "mass = 0.03\nheld = \"start\""}},
      "shot.toml:16:1: cords \"net\": held goes with shape = \"rope\" or shape = \"knots\" or shape = \"mesh\", "
      "not with shape = \"net\"");
  expect_fault({{"shape = \"net\"", "shape = \"rope\"\nto = [1, 0, 0]\nheld = \"strat\""}},
               "shot.toml:16:8: cords \"net\": held = \"strat\" is not known (did you mean \"start\"?)");
  expect_fault({{"shape = \"net\"", "shape = \"rope\"\nto = [0, 0, 0]"}},
               "shot.toml:15:1: cords \"net\": to is where it starts; its length would be 0");
  expect_fault({{"shape = \"net\"", "shape = \"knots\"\nto = [0, 1, 0]\nknots = 3\nknot_mass = 0.01"}},
               "shot.toml:17:1: cords \"net\": its knots weigh 0.03 kg, and all of it only mass = 0.03");
  expect_fault({{"mass = 0.03", "mass = 0.03\ncolumns = 1000\nrows = 1000"}},
               "shot.toml:13:1: cords \"net\": would be of 4000000 pieces, at most 1000000 are baked");
  expect_fault({{"kind = \"damping\"", "kind = \"damping\"\ndensity = 1000"}},
               "shot.toml:20:1: standin \"air\": density goes with kind = \"water\", not with kind = \"damping\"");
  expect_fault({{"height = 0.42\n", ""}},
               "shot.toml:18:1: standin \"air\": height is missing; shape = \"cone\" needs it");
  expect_fault({{"damping = 3.9", "damping = 3.9\nfrom = 20\nuntil = 10"}},
               "shot.toml:26:1: standin \"air\": until = 10 is not after from = 20: it would never act");
}

TEST_F(CordsShot, Stand_ins_that_do_nothing_are_refused) {
  const std::string nothing = "shot.toml:18:1: standin \"air\": does nothing without ";
  expect_fault({{"damping = 3.9", ""}}, nothing + "damping, damping_quadratic or damping_spin above 0");
  expect_fault({{"height = 0.42", "height = 0"}}, nothing + "a cone with height and radius above 0");
}

TEST_F(CordsShot, A_rope_is_held_at_its_start_unless_it_says_otherwise) {
  std::string text = k_basketball;
  text.replace(text.find("shape = \"net\""), 13, "shape = \"rope\"\nto = [0, 9, 0]");
  const auto rope = parse(text);
  ASSERT_TRUE(rope.ok()) << rope.error().text();
  EXPECT_EQ(cords_of(rope, 0).held, "start");
  EXPECT_EQ(cords_of(rope, 0).points, 32);
  EXPECT_EQ(cords_of(parse(text, {"cords.net.held=both"}), 0).held, "both");
}

TEST_F(CordsShot, Cut_or_damaged_anywhere_is_a_shot_or_faults) {
  const std::string good = k_basketball;
  for (std::size_t n = 0; n <= good.size(); ++n) {
    const auto shot = parse(good.substr(0, n));
    EXPECT_EQ(shot.ok(), faults_.messages.empty());
  }
  using namespace std::string_view_literals;
  const test::TextDamage damage{"[]{}=\"'.,-0159eE\n #_\\+:\x00\xff\xc3zinfNaT"sv, 4, 30};
  int accepted = 0;
  for (std::uint64_t round = 0; round < 2'000; ++round) {
    const auto shot = parse(test::damaged(good, damage, round));
    ASSERT_EQ(shot.ok(), faults_.messages.empty());
    ASSERT_TRUE(shot.ok() ? !canonical(*shot).empty() : !shot.error().what.empty());
    accepted += shot.ok() ? 1 : 0;
  }
  EXPECT_GT(accepted, 20);
}

TEST_F(CordsShot, Slips_are_recognised_and_the_right_word_is_named) {
  const std::vector<std::pair<std::string, std::string>> slips = {
      {"colums = 12", "unknown key \"colums\" (did you mean \"columns\"?)"},
      {"loops = 12", "unknown key \"loops\" (did you mean \"columns\"?)"},
      {"EA = 3000", "unknown key \"EA\" (did you mean \"stretch\"?)"},
      {"hollow = true", "unknown key \"hollow\" (it belongs under [primary.NAME])"},
      {"drag = 1", "unknown key \"drag\" (it belongs under [standin.NAME])"},
      {"columns = 2", "columns = 2 is outside [3, 1000]"},
      {"columns = 12.5", "columns needs a whole number, not 12.5"},
      {"radius = 3", "radius = 3 is outside [0.0005, 0.05] m (3 mm is written 0.003)"},
      {"length = \"42 cm\"", "length needs a number, not the text \"42 cm\" (42 cm is written 0.42)"},
  };
  for (const auto& [line, fault] : slips) {
    const auto faults = faults_when({{"mass = 0.03", "mass = 0.03\n" + line}});
    ASSERT_EQ(faults.size(), 1u) << line;
    EXPECT_TRUE(faults[0].ends_with(": cords \"net\": " + fault)) << faults[0];
  }
  const auto section = faults_when({{"[cords.net]", "[cord.net]"}});
  EXPECT_NE(section[0].find("unknown section [cord] (did you mean \"cords\"?)"), std::string::npos) << section[0];
}

TEST_F(CordsShot, Overrides_reach_every_new_section_and_name_slips) {
  const auto shot = parse(k_basketball, {"primary.ball.spin=[0,0,6.28]", "cords.net.rows=8", "standin.air.damping=5"});
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(shot->primaries[0].spin.z(), 6.28);
  EXPECT_EQ(cords_of(shot, 0).rows, 8);
  EXPECT_EQ(shot->standins[0].damping, 5);
  EXPECT_EQ(faults_when({}, {"cords.ned.rows=8"}),
            std::vector<std::string>{"--set cords.ned.rows=8: there is no cords \"ned\" (did you mean \"net\"?)"});
  EXPECT_EQ(faults_when({}, {"cords.net=8"}),
            std::vector<std::string>{"--set cords.net=8: is not of the form cords.NAME.key=value"});
}

TEST_F(CordsShot, Names_of_caches_are_used_once) {
  expect_fault({{"[cords.net]", "[cords.ball]"}},
               "shot.toml:13:8: cords \"ball\": a primary has the same name, their caches would overwrite each other");
  expect_fault({{"", "[cloth.net]\nmesh = \"dress.obj\"\n"}, {"damping = 3.9", "damping = 3.9\nfor = \"net\""}},
               "shot.toml:13:8: cords \"net\": a cloth has the same name, their caches would overwrite each other");
}

/// A shot in which the key may be set: every shape and kind has one.
std::string shot_for(std::string_view key) {
  const auto is_one = [&](const std::vector<std::string_view>& keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  std::string primary = "shape = \"sphere\"\nradius = 0.1\n", cords = "shape = \"net\"\n",
              standin = "kind = \"fitted\"\n";
  if (key == "size") primary = "shape = \"box\"\nsize = [1, 1, 1]\n";
  if (key == "length") primary = "shape = \"capsule\"\nradius = 0.1\nlength = 1\n";
  if (is_one({"to", "held"})) cords = "shape = \"rope\"\nto = [0, 9, 0]\n";
  if (is_one({"knots", "knot_mass"})) cords = "shape = \"knots\"\nto = [0, 9, 0]\n";
  if (is_one({"mesh", "unit_scale", "up"})) cords = "shape = \"mesh\"\nmesh = \"dress.obj\"\n";
  if (is_one({"radius_top", "radius_bottom", "height", "soft_edge", "damping", "damping_quadratic", "damping_spin"}))
    standin = "kind = \"damping\"\ndamping = 1\nshape = \"cone\"\nradius_top = 1\nradius_bottom = 1\nheight = 1\n";
  if (is_one({"shape", "size", "mesh"}))
    standin = "kind = \"damping\"\ndamping = 1\nshape = \"box\"\nsize = [1, 1, 1]\n";
  if (key == "mesh") standin = "kind = \"damping\"\ndamping = 1\nshape = \"mesh\"\nmesh = \"dress.obj\"\n";
  if (is_one({"stiffness", "stiffness_cubic", "damping_ratio"})) standin = "kind = \"mat\"\nstiffness = 1e3\n";
  if (is_one({"density", "drag", "slam"})) standin = "kind = \"water\"\n";
  if (is_one({"length", "anchor"})) standin = "kind = \"spring\"\nstiffness = 1\nanchor = [0, 9, 0]\nlength = 1\n";
  if (key == "mass") standin = "kind = \"weight\"\nmass = 1\n";
  std::string out = "[shot]\nframes = 1\n[primary.p]\n" + primary + "mass = 0.68\n[cords.c]\n" + cords +
                    "mass = 50\n[standin.s]\n" + standin;
  return out;
}

TEST_F(CordsShot, Every_key_can_be_set_changes_the_canonical_text_and_is_in_the_reference) {
  const std::string reference = shot_file_reference(words());
  int count = 0;
  const auto check = [&](const std::string& section, auto keys) {
    for (const auto& key : keys) {
      std::string value = "7";
      if (key.name == "shape" || key.name == "kind" || key.name == "coupling" || key.name == "on" || key.name == "for")
        continue;  // tested above
      if (!key.choices.empty()) value = split_words(key.choices).back();
      const auto before = parse(shot_for(key.name));
      ASSERT_TRUE(before.ok()) << section << " " << key.name << ": " << before.error().text();
      bool taken = false;
      for (const std::string& v : {value, std::string("0.015"), std::string("[2, 2, 2]"), std::string("true"),
                                   std::string("walk.fbx"), std::string("end")}) {
        const auto after = parse(shot_for(key.name), {section + "." + std::string(key.name) + "=" + v});
        if (!after.ok()) continue;
        taken = true;
        EXPECT_NE(canonical(*before), canonical(*after)) << section << "." << key.name << " = " << v;
        break;
      }
      EXPECT_TRUE(taken) << section << "." << key.name << " takes nothing";
      EXPECT_NE(reference.find("| `" + std::string(key.name) + "` |"), std::string::npos) << key.name;
      EXPECT_FALSE(key.meaning.empty()) << key.name;
      ++count;
    }
  };
  check("primary.p", prop_keys());
  check("cords.c", cords_keys());
  check("standin.s", standin_keys());
  EXPECT_GT(count, 50);
}

TEST_F(CordsShot, Defaults_of_the_structs_lie_within_the_table) {
  const auto check = [](auto keys, const auto& spec) {
    for (const auto& key : keys) {
      if (key.required || (key.lowest == 0 && key.highest == 0)) continue;
      using Spec = std::decay_t<decltype(spec)>;
      double value = key.lowest;
      if (const auto* member = std::get_if<double Spec::*>(&key.target)) value = spec.**member;
      if (const auto* whole = std::get_if<int Spec::*>(&key.target)) value = spec.**whole;
      EXPECT_TRUE(value >= key.lowest && value <= key.highest) << key.name;
    }
  };
  check(prop_keys(), PrimarySpec{});
  check(yield_keys(), PrimarySpec{});
  check(cords_keys(), CordsSpec{});
  check(standin_keys(), StandInKeys{});
}

}  // namespace
}  // namespace ft

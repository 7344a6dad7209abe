#include "tests/io_shot/shot_fixture.h"

namespace ft {
namespace {

TEST_F(ShotFile, Good_file_gives_what_it_says) {
  const auto shot = parse(k_good);
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(shot->first_frame, 1001);
  EXPECT_EQ(shot->last_frame, 1121);
  EXPECT_EQ(shot->fps, 25);
  ASSERT_EQ(shot->primaries.size(), 1u);
  EXPECT_EQ(shot->primaries[0].file, folder_ / "mannequin.glb");
  EXPECT_EQ(shot->primaries[0].clip, "Rumba");
  ASSERT_EQ(cloth_count(shot), 2u);
  const ClothSpec& dress = cloth_of(shot, 0);
  EXPECT_EQ(dress.name, "dress");
  EXPECT_EQ(dress.mesh, folder_ / "dress.obj");
  ASSERT_EQ(dress.fabric_overrides.size(), 1u);
  EXPECT_EQ(dress.fabric_overrides[0], (std::pair<std::string, double>("mass_per_area", 0.2)));
  ASSERT_EQ(dress.pins.size(), 4u);
  EXPECT_EQ(dress.pins[0].select, PinSpec::Select::k_group);
  EXPECT_EQ(dress.pins[0].group, "waist");
  EXPECT_EQ(dress.pins[1].select, PinSpec::Select::k_within);
  EXPECT_EQ(dress.pins[1].within, 0.02);
  EXPECT_EQ(dress.pins[1].stiffness, 1e5);
  EXPECT_EQ(dress.pins[1].max_pull, 100);
  EXPECT_EQ(dress.pins[2].select, PinSpec::Select::k_vertices);
  EXPECT_EQ(dress.pins[2].vertices.size(), 201u);
  EXPECT_EQ(dress.pins[3].vertices, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(cloth_of(shot, 1).on, "mannequin") << "the only primary";
  ASSERT_EQ(cloth_of(shot, 1).pins.size(), 1u);
  EXPECT_EQ(cloth_of(shot, 1).pins[0].group, "neck");
}

TEST_F(ShotFile, Cloths_keep_the_order_of_the_file) {
  std::string text = "[shot]\nframes = 1\n[primary.m]\nfile = \"walk.fbx\"\n";
  for (const char* name : {"zebra", "apple", "mango"})
    text += std::string("[cloth.") + name + "]\nmesh = \"dress.obj\"\n";
  const auto shot = parse(text);
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  EXPECT_EQ(cloth_of(shot, 0).name, "zebra");
  EXPECT_EQ(cloth_of(shot, 1).name, "apple");
  EXPECT_EQ(cloth_of(shot, 2).name, "mango");
}

TEST_F(ShotFile, Every_fault_is_reported_at_once_with_place_range_and_guess) {
  const auto faults = faults_of(R"(fps = 24
[shot]
frames = "1121-1001"
fsp = 25
preroll = 2000
framerate = 30

[primary.mannequin]
file = "manequin.glb"
clip = 3
speed = "50%"
height = 175

[cloth.cape]
mesh = "dres.obj"
fabric = "cottn"
on = "manekin"
mass_per_area = 150
thickness = "3 mm"
friction = 40
shaer = 100
self_collision = "yes"
offset = [0, 1]
pins = [ { group = "waist", within = 0.02 }, { wihtin = 0.02 }, 5, { vertices = "0-x" } ]
velocity = [1, 2, 3]

[wind]
velocity = 5
[wnd]
x = 1
[solver]
gravity = [0, -981, 0]
min_substeps = 64
newton_iterations = 2.5
[cache]
formats = ["abcd", "pc2", "pc2"]
[gate]
p99_strain = 50
crossings = 1
)");
  const std::vector<std::string> expected = {
      "shot.toml:1:1: key \"fps\" stands outside of any section (it belongs under [shot])",
      "shot.toml:3:10: [shot]: frames = \"1121-1001\" runs backwards (1001-1121?)",
      "shot.toml:4:1: [shot]: unknown key \"fsp\" (did you mean \"fps\"?)",
      "shot.toml:5:11: [shot]: preroll = 2000 is outside [0, 1000] frames",
      "shot.toml:6:1: [shot]: unknown key \"framerate\" (did you mean \"fps\"?)",
      "shot.toml:9:8: primary \"mannequin\": file = \"manequin.glb\" does not exist (did you mean \"mannequin.glb\"?)",
      "shot.toml:10:8: primary \"mannequin\": clip needs a text, not the number 3 (write \"3\")",
      "shot.toml:11:9: primary \"mannequin\": speed needs a number, not the text \"50%\" (50% is written 0.5)",
      "shot.toml:12:10: primary \"mannequin\": height = 175 is outside [0.05, 50] m (175 cm is written 1.75)",
      "shot.toml:15:8: cloth \"cape\": mesh = \"dres.obj\" does not exist (did you mean \"dress.obj\"?)",
      "shot.toml:16:10: cloth \"cape\": fabric = \"cottn\" is not known (did you mean \"cotton\"?)",
      "shot.toml:17:6: cloth \"cape\": on = \"manekin\" names no primary (known: mannequin)",
      "shot.toml:18:17: cloth \"cape\": mass_per_area = 150 is outside [0.02, 2] kg/m2 (150 g/m2 is written 0.15)",
      "shot.toml:19:13: cloth \"cape\": thickness needs a number, not the text \"3 mm\" (3 mm is written 0.003)",
      "shot.toml:20:12: cloth \"cape\": friction = 40 is outside [0, 2] (40 % is written 0.4)",
      "shot.toml:21:1: cloth \"cape\": unknown key \"shaer\" (did you mean \"shear\"?)",
      "shot.toml:22:18: cloth \"cape\": self_collision needs true or false, not the text \"yes\" (write true)",
      "shot.toml:23:10: cloth \"cape\": offset needs three numbers [x, y, z], not a list of 2",
      "shot.toml:24:10: cloth \"cape\", pin 1: needs one of group, within, vertices, file, and has 2 (several pins are "
      "written as several { } in the list)",
      "shot.toml:24:46: cloth \"cape\", pin 2: needs one of group, within, vertices, file, and has none (several pins "
      "are written as several { } in the list)",
      "shot.toml:24:48: cloth \"cape\", pin 2: unknown key \"wihtin\" (did you mean \"within\"?)",
      "shot.toml:24:65: cloth \"cape\", pin 3 needs a table like { group = \"waist\" } or { within = 0.02 }, not the "
      "number 5",
      "shot.toml:24:81: cloth \"cape\", pin 4: vertices has \"0-x\" where a vertex or a range like 0-199 belongs",
      "shot.toml:25:1: cloth \"cape\": unknown key \"velocity\" (it belongs under [wind])",
      "shot.toml:28:12: [wind]: velocity needs three numbers [x, y, z], not the number 5",
      "shot.toml:29:2: unknown section [wnd] (did you mean \"wind\"?)",
      "shot.toml:32:15: [solver]: gravity = -981 is outside [-100, 100] m/s2 (-981 cm/s2 is written -9.81)",
      "shot.toml:33:16: [solver]: min_substeps = 64 is above max_substeps = 32",
      "shot.toml:34:21: [solver]: newton_iterations needs a whole number, not 2.5",
      "shot.toml:36:12: [cache]: formats = \"abcd\" is not known (did you mean \"abc\"?)",
      "shot.toml:36:27: [cache]: formats names \"pc2\" twice",
      "shot.toml:38:14: [gate]: p99_strain = 50 is outside [0, 10] (50 % is written 0.5)",
      "shot.toml:39:13: [gate]: crossings needs true or false, not the number 1 (write true)",
  };
  for (std::size_t i = 0; i < std::max(faults.size(), expected.size()); ++i)
    EXPECT_EQ(i < faults.size() ? faults[i] : "nothing", i < expected.size() ? expected[i] : "nothing");
}

TEST_F(ShotFile, What_is_missing_from_the_file_is_named) {
  EXPECT_EQ(faults_of(""), (std::vector<std::string>{
                               "shot.toml: has no [shot] section: frames = \"1-100\" is needed",
                               "shot.toml: has no [primary.NAME] section: the character that the cloth is worn by",
                               "shot.toml: has no [cloth.NAME] or [cords.NAME] or [follow.NAME] or [leaves.NAME] or "
                               "[hair.NAME] or [water.NAME] "
                               "section: there is nothing to bake"}));
  EXPECT_NE(fault_with("frames = \"1001-1121\"\n", "").find("shot.toml:1:1: [shot]: frames is missing"),
            std::string::npos);
  EXPECT_NE(fault_with("file = \"mannequin.glb\"\n", "").find("primary \"mannequin\": file is missing"),
            std::string::npos);
  EXPECT_NE(fault_with("mesh = \"dress.obj\"\nfabric", "fabric").find("cloth \"dress\": mesh is missing"),
            std::string::npos);
}

TEST_F(ShotFile, Frames_are_read_and_their_slips_explained) {
  const auto frames = [&](const std::string& value) {
    return fault_with("frames = \"1001-1121\"", "frames = " + value);
  };
  EXPECT_NE(
      frames("\"-10-20\"")
          .find("has a negative frame; frames count from 0, a run-up before the first frame is written preroll = 10"),
      std::string::npos);
  EXPECT_NE(frames("-5").find("negative frame"), std::string::npos);
  EXPECT_NE(frames("\"abc\"").find("is not a frame range"), std::string::npos);
  EXPECT_NE(frames("\"1-2-3\"").find("is not a frame range"), std::string::npos);
  EXPECT_NE(frames("\"\"").find("is not a frame range"), std::string::npos);
  EXPECT_NE(frames("[1001, 1121]").find("write \"1001-1121\""), std::string::npos);
  EXPECT_NE(frames("\"1-99999999999\"").find("outside [0, 9999999]"), std::string::npos);
  EXPECT_NE(frames("\"1-9999999\"").find("at most 100000 are baked at once"), std::string::npos);
  EXPECT_NE(frames("true").find("needs a text, not true"), std::string::npos);
  for (const char* value : {"\"1001\"", "1001", "\" 1001 - 1121 \"", "\"1001..1121\"", "\"1001:1121\""}) {
    std::string text = k_good;
    text.replace(text.find("\"1001-1121\""), 11, value);
    const auto shot = parse(text);
    ASSERT_TRUE(shot.ok()) << value;
    EXPECT_EQ(shot->first_frame, 1001);
    EXPECT_TRUE(shot->last_frame == 1121 || shot->last_frame == 1001) << value;
  }
}

TEST_F(ShotFile, Syntax_faults_say_what_to_write) {
  EXPECT_NE(fault_with("\"1001-1121\"", "1001-1121").find("(text needs quotes: frames = \"1001-1121\")"),
            std::string::npos);
  EXPECT_NE(fault_with("fabric = \"cotton\"", "fabric = cotton").find("(text needs quotes: fabric = \"cotton\")"),
            std::string::npos);
  EXPECT_NE(fault_with("fps = 25", "fps: 25").find("(a key is written name = value"), std::string::npos);
  EXPECT_NE(fault_with("fps = 25", "fps = 23,976").find("numbers are written with a point"), std::string::npos);
  EXPECT_NE(fault_with("fps = 25", "write_preroll = True").find("(write true or false)"), std::string::npos);
  EXPECT_NE(fault_with("fps = 25", "fps = 25 fps").find("numbers are written without a unit"), std::string::npos);
  EXPECT_NE(fault_with("fps = 25", "fps =").find("the value is missing"), std::string::npos);
  EXPECT_EQ(fault_with("fps = 25", "fps = 25\nfps = 24"), "shot.toml:4:7: 'fps' is there twice");
  EXPECT_EQ(fault_with("[cloth.cape]", "[cloth.dress]"), "shot.toml:17:1: 'cloth.dress' is there twice");
  EXPECT_NE(fault_with("[cloth.cape]", "[cloth.my cape]").find("[cloth.\"my dress\"]"), std::string::npos);
  EXPECT_NE(fault_with("\"cotton\"", "\"cotton").find("a text has no closing quote"), std::string::npos);
  EXPECT_EQ(faults_of("\xff\xfe")[0], "shot.toml:1:1: is not a text file in UTF-8");
}

TEST_F(ShotFile, Sections_without_a_name_say_how_to_give_one) {
  EXPECT_NE(faults_of("[shot]\nframes = 1\n[primary.m]\nfile = \"walk.fbx\"\n[cloth]\nmesh = \"dress.obj\"\n")[0].find(
                "write [cloth.NAME], one section for each"),
            std::string::npos);
  EXPECT_NE(
      faults_of("[shot]\nframes = 1\n[primary.m]\nfile = \"walk.fbx\"\n[[cloth]]\nmesh = \"dress.obj\"\n")[0].find(
          "write [cloth.NAME], one section for each"),
      std::string::npos);
  EXPECT_NE(fault_with("[cloth.cape]", "[cloth.\"a/b\"]").find("the name becomes a file name"), std::string::npos);
  EXPECT_NE(fault_with("[cloth.cape]", "[cloth.mannequin]").find("a primary has the same name"), std::string::npos);
}

TEST_F(ShotFile, Cloth_with_several_primaries_needs_to_say_on_which) {
  const std::string two =
      "[shot]\nframes = 1\n[primary.anna]\nfile = \"walk.fbx\"\n[primary.bert]\nfile = \"walk.fbx\"\n[cloth.c]\nmesh = "
      "\"dress.obj\"\n";
  EXPECT_NE(faults_of(two)[0].find("on is missing; it says who wears it (one of: anna, bert)"), std::string::npos);
  EXPECT_NE(faults_of(two + "on = \"berta\"\n")[0].find("did you mean \"bert\"?"), std::string::npos);
  EXPECT_TRUE(faults_of(two + "on = \"bert\"\n").empty());
}

TEST_F(ShotFile, Only_missing_files_are_an_input_error_all_else_is_usage) {
  std::string text = k_good;
  text.replace(text.find("mannequin.glb"), 13, "mannequin.gbl");
  EXPECT_EQ(parse(text).error().kind, ErrorKind::k_input);
  text.replace(text.find("fps = 25"), 8, "fps = 0 ");
  EXPECT_EQ(parse(text).error().kind, ErrorKind::k_usage);
  EXPECT_NE(parse(text).error().hint.find("and 1 more fault"), std::string::npos);
}

TEST_F(ShotFile, Missing_shot_file_and_folder_are_named_with_a_guess) {
  ASSERT_TRUE(write_text_durably(folder_ / "shot.toml", k_good).ok());
  const auto missing = read_shot(folder_ / "shto.toml", words(), {}, faults_);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().kind, ErrorKind::k_input);
  EXPECT_EQ(missing.error().hint, "did you mean \"shot.toml\"?");
  EXPECT_EQ(faults_.messages.size(), 1u);
  EXPECT_TRUE(read_shot(folder_ / "shot.toml", words(), {}, faults_).ok());
  EXPECT_TRUE(faults_.messages.empty());
  EXPECT_NE(fault_with("\"mannequin.glb\"", "\"chars/m.glb\"").find("there is no folder"), std::string::npos);
  EXPECT_NE(fault_with("\"mannequin.glb\"", "'chars\\m.glb'").find("folders are separated by /"), std::string::npos);
}

}  // namespace
}  // namespace ft

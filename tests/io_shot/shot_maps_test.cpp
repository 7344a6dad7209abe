// Maps in the shot file and the files of numbers behind them.
#include <cmath>

#include "baker/systems/cloth/cloth_maps.h"
#include "io/shot/shot_keys.h"
#include "io/shot/vertex_values.h"
#include "tests/io_shot/shot_fixture.h"

namespace ft {
namespace {

const char* const k_pin_line = "pin = \"neck\"";

TEST_F(ShotFile, Maps_are_read_in_a_list_or_as_sections) {
  ASSERT_TRUE(write_text_durably(folder_ / "cape.csv", "x").ok());
  std::string text = k_good;
  text.replace(text.find(k_pin_line), std::string(k_pin_line).size(),
               "maps = [ { of = \"thickness\", from = \"red\", low = 1e-3, high = 4e-3 }, { of = \"mass_per_area\", "
               "file = \"cape.csv\" } ]\n"
               "pins = [ { file = \"cape.csv\", column = \"neck\" } ]\n"
               "[[cloth.dress.maps]]\nof = \"bend\"\nfile = \"cape.csv\"\ncolumn = \"b\"\nlow = 1\nhigh = 20");
  const auto shot = parse(text);
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  const ClothSpec &dress = cloth_of(shot, 0), &cape = cloth_of(shot, 1);
  ASSERT_EQ(cape.maps.size(), 2u);
  EXPECT_EQ(cape.maps[0].of, "thickness");
  EXPECT_EQ(cape.maps[0].from, "red");
  EXPECT_EQ(cape.maps[0].low, 1e-3);
  EXPECT_EQ(cape.maps[0].high, 4e-3);
  EXPECT_EQ(cape.maps[1].file.filename(), "cape.csv");
  EXPECT_FALSE(cape.maps[1].low || cape.maps[1].high);
  ASSERT_EQ(dress.maps.size(), 1u);
  EXPECT_EQ(dress.maps[0].column, "b");
  ASSERT_EQ(cape.pins.size(), 1u);
  EXPECT_EQ(cape.pins[0].select, PinSpec::Select::k_file);
  EXPECT_EQ(cape.pins[0].column, "neck");
  const std::string all = canonical(*shot);
  EXPECT_NE(all.find("cloth.cape.maps = [{ of = \"thickness\", from = \"red\", low = 0.001, high = 0.004 }, { of = "
                     "\"mass_per_area\", file = \"cape.csv\" }]\n"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("{ file = \"cape.csv\", column = \"neck\", stiffness = 1000000, max_pull = 5000 }"),
            std::string::npos)
      << all;
  EXPECT_EQ(canonical(*parse(k_good)).find("maps"), std::string::npos) << "a shot without maps is what it was";
}

TEST_F(ShotFile, Faults_of_maps_name_place_range_and_what_was_meant) {
  const auto fault = [&](const std::string& map) {
    return fault_with(k_pin_line, std::string("maps = [ ").append(map).append(" ]"));
  };
  const std::string map = "shot.toml:19:10: cloth \"cape\", map 1: ";
  EXPECT_EQ(fault("{ of = \"thicknes\", from = \"red\", low = 1, high = 2 }"),
            "shot.toml:19:17: cloth \"cape\", map 1: of = \"thicknes\" is nothing that can vary (did you mean "
            "\"thickness\"?)");
  EXPECT_NE(fault("{ of = \"density\", from = \"red\", low = 1, high = 2 }").find("did you mean \"mass_per_area\"?"),
            std::string::npos);
  EXPECT_NE(fault("{ of = \"pin\", from = \"red\", low = 0, high = 1 }").find("pins take weights themselves"),
            std::string::npos);
  EXPECT_EQ(fault("{ of = \"thickness\", from = \"red\", low = 1, high = 4e-3 }"),
            "shot.toml:19:50: cloth \"cape\", map 1: low = 1 is outside [0.0005, 0.01] m (1 mm is written 0.001)");
  EXPECT_EQ(fault("{ of = \"bend\", low = 1, high = 2 }"),
            map + "needs from = \"red\" (a colour channel or vertex group) or file = \"values.csv\"");
  EXPECT_EQ(fault("{ of = \"bend\", from = \"red\" }"),
            map + "from needs low and high, the values where the weight is 0 and where it is 1");
  EXPECT_NE(fault("{ of = \"bend\", from = \"red\", low = 1 }").find("low needs high beside it"), std::string::npos);
  EXPECT_NE(fault("{ of = \"bend\", from = \"red\", column = \"a\", low = 1, high = 2 }").find("there is no file"),
            std::string::npos);
  EXPECT_NE(fault("{ from = \"red\", low = 1, high = 2 }").find("of is missing"), std::string::npos);
  EXPECT_NE(fault("{ of = \"bend\", from = \"red\", low = 1, high = 2, maximum = 3 }").find("did you mean \"high\"?"),
            std::string::npos);
  EXPECT_NE(fault("{ of = \"bend\", file = \"dres.obj\" }").find("did you mean \"dress.obj\"?"), std::string::npos);
  EXPECT_NE(fault("7").find("needs a table like"), std::string::npos);
  EXPECT_NE(
      fault(
          "{ of = \"bend\", from = \"red\", low = 1, high = 2 }, { of = \"bend\", from = \"blue\", low = 1, high = 3 }")
          .find("bend has two maps; it takes one"),
      std::string::npos);
  EXPECT_NE(fault_with("[cache]", "[[maps]]\n[cache]").find("maps belong under [cloth.NAME]"), std::string::npos);
}

TEST_F(ShotFile, Pins_say_from_when_until_when_and_how_gently_they_hold) {
  const auto shot = parse(k_good, {"cloth.cape.pins=[{within=0.01, from=1010, until=1050.5, fade=12}]"});
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  const PinSpec& pin = cloth_of(shot, 1).pins.back();
  EXPECT_EQ(pin.from, 1010);
  EXPECT_EQ(pin.until, 1050.5);
  EXPECT_EQ(pin.fade, 12);
  EXPECT_NE(canonical(*shot).find("max_pull = 5000, from = 1010, until = 1050.5, fade = 12 }"), std::string::npos)
      << canonical(*shot);
  EXPECT_EQ(canonical(*parse(k_good)).find("until"), std::string::npos) << "a shot without them is what it was";
  const auto fault = [&](const std::string& keys) {
    return fault_with(k_pin_line, std::string("pins = [ { group = \"neck\", ").append(keys).append(" } ]"));
  };
  EXPECT_EQ(fault("from = 1050, until = 1010"),
            "shot.toml:19:41: cloth \"cape\", pin 1: until = 1010 is not after from = 1050: it would never hold");
  EXPECT_NE(fault("fade = 5").find("fade needs until (or from), the frame at which it begins"), std::string::npos);
  EXPECT_NE(fault("until = -3").find("until = -3 is outside [0, 9999999] frame"), std::string::npos);
  EXPECT_NE(fault("release = 1010").find("did you mean \"until\"?"), std::string::npos);
}

TEST_F(ShotFile, Pins_hold_to_a_cloth_of_the_same_primary_and_open_like_a_zip) {
  const auto shot =
      parse(k_good, {"cloth.cape.pins=[{within=0.01, to=\"dress\", until=1050, fade=24, opens=[0, -1, 0]}]"});
  ASSERT_TRUE(shot.ok()) << shot.error().text();
  const PinSpec& pin = cloth_of(shot, 1).pins.back();
  EXPECT_EQ(pin.to, "dress");
  EXPECT_EQ(pin.opens, Vec3(0, -1, 0));
  EXPECT_NE(canonical(*shot).find("until = 1050, fade = 24, to = \"dress\", opens = [0, -1, 0] }"), std::string::npos)
      << canonical(*shot);
  EXPECT_EQ(canonical(*parse(k_good)).find(" to = "), std::string::npos) << "a shot without them is what it was";
  EXPECT_TRUE(parse(k_good, {"cloth.cape.pins=[{vertices=\"5\", to=\"cape\"}]"}).ok()) << "its own other side";
  const auto fault = [&](const std::string& keys) {
    return fault_with(k_pin_line, std::string("pins = [ { ").append(keys).append(" } ]"));
  };
  EXPECT_EQ(fault("group = \"neck\", to = \"dres\""),
            "shot.toml:19:8: cloth \"cape\": to = \"dres\" names no cloth (did you mean \"dress\"?)");
  EXPECT_EQ(
      fault("group = \"neck\", to = \"mannequin\""),
      "shot.toml:19:8: cloth \"cape\": to = \"mannequin\" names no cloth (a pin without to holds to the primary)");
  EXPECT_NE(fault("within = 0.01, to = \"cape\"").find("say which side by group, vertices or file"), std::string::npos);
  EXPECT_NE(fault("group = \"neck\", to = \"dress\", opens = [0, 1, 0]").find("opens needs fade"), std::string::npos);
  EXPECT_NE(fault("group = \"neck\", to = \"dress\", max_pull = 5").find("max_pull does not go with to"),
            std::string::npos);
  EXPECT_NE(fault("group = \"neck\", button = \"dress\"").find("did you mean \"to\"?"), std::string::npos);
  EXPECT_NE(fault("group = \"neck\", to = 1050").find("needs a text"), std::string::npos);
  std::string two = k_good;
  two.replace(two.find(k_pin_line), std::string(k_pin_line).size(),
              "on = \"other\"\npins = [ { group = \"neck\", to = \"dress\" } ]");
  two.append("\n[primary.other]\nfile = \"walk.fbx\"\n");
  const auto faults = faults_of(two);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].find("to = \"dress\" is worn by another primary"), std::string::npos) << faults[0];
}

TEST_F(ShotFile, Every_kind_of_map_has_a_range_that_the_reference_prints) {
  const std::string reference = shot_file_reference(words());
  for (const MapKind& kind : map_kinds()) {
    EXPECT_LT(kind.lowest, kind.highest);
    EXPECT_NE(reference.find(std::string("`").append(kind.name).append("`")), std::string::npos);
    EXPECT_EQ(find_map_kind(kind.name), &kind);
  }
  for (const auto& key : map_keys())
    EXPECT_NE(reference.find(std::string("| `").append(key.name).append("` |")), std::string::npos) << key.name;
}

TEST(VertexValues, Text_and_tables_of_all_usual_forms_hold_the_same_numbers) {
  for (const char* text : {"0.5\n1\n-2e-3\n", "\xef\xbb\xbf# thickness\r\n0.5\r\n\r\n+1\r\n-0.002",
                           "t\n0.5\n1\n-2e-3\n", "\"t\"\n0.5 # first\n1\n-.002\n"}) {
    const auto values = parse_vertex_values(text, "v.txt");
    ASSERT_TRUE(values) << values.error().text();
    ASSERT_EQ(values->values.size(), 1u);
    EXPECT_EQ(values->values[0], (std::vector<double>{0.5, 1, -2e-3})) << text;
  }
  for (const char* text : {"a,b\n1,2\n3,4\n", "a; b\n1; 2\n3; 4", "a\tb\n1\t2\n3\t4\n", "  a  b\n 1   2\n 3   4 \n"}) {
    const auto values = parse_vertex_values(text, "v.csv");
    ASSERT_TRUE(values) << values.error().text();
    EXPECT_EQ(values->columns, (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(values->values[1], (std::vector<double>{2, 4}));
    EXPECT_EQ(values->lines, (std::vector<int>{2, 3}));
  }
}

TEST(VertexValues, What_is_no_number_names_its_line_and_its_vertex) {
  const auto message = [](const char* text) {
    const auto values = parse_vertex_values(text, "v.csv");
    return values ? std::string("read") : values.error().text();
  };
  EXPECT_NE(message("t\n1\n\nx\n").find("v.csv:4"), std::string::npos);
  EXPECT_NE(message("t\n1\n\nx\n").find("has \"x\" for a number of vertex 1"), std::string::npos);
  EXPECT_NE(message("t\n1\nnan\n").find("has column \"t\" nan for vertex 1"), std::string::npos);
  EXPECT_NE(message("1\ninf\n").find("vertex 1"), std::string::npos);
  EXPECT_NE(message("1,2\n3\n").find("has 1 numbers for vertex 1, the line before it has 2"), std::string::npos);
  EXPECT_NE(message("a,b\n1,\n").find("has \"\" for a number of vertex 0"), std::string::npos);
  EXPECT_NE(message("1\n1e999\n").find("vertex 1"), std::string::npos);
  EXPECT_NE(message("").find("holds no numbers"), std::string::npos);
  EXPECT_NE(message("thickness\n").find("holds no numbers"), std::string::npos);
}

TEST_F(ShotFile, Columns_are_chosen_by_name_and_judged_by_count_and_range) {
  const auto file = folder_ / "v.csv";
  ASSERT_TRUE(write_text_durably(file, "red,thick\n0,0.002\n1,3\n0.5,0.004\n").ok());
  const auto red = vertex_column(file, "red", 3, 0, 1, "1");
  ASSERT_TRUE(red) << red.error().text();
  EXPECT_EQ(*red, (std::vector<double>{0, 1, 0.5}));
  const auto message = [&](const std::string& column, int count) {
    const auto values = vertex_column(file, column, count, 0.5e-3, 10e-3, "m");
    return values ? std::string("read") : values.error().text();
  };
  const std::string outside = message("thick", 3);
  for (const char* part :
       {"v.csv:3", "column \"thick\" = 3 for vertex 1 is outside [0.0005, 0.01] m", "3 mm is written 0.003"})
    EXPECT_NE(outside.find(part), std::string::npos) << outside;
  EXPECT_NE(message("thick", 4).find("has 3 lines of numbers, the mesh has 4 vertices"), std::string::npos);
  EXPECT_NE(message("thik", 3).find("did you mean \"thick\"?"), std::string::npos);
  EXPECT_NE(message("", 3).find("red, thick"), std::string::npos);
}

}  // namespace
}  // namespace ft

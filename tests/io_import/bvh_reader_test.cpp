// The reader of BVH files: what good files of every spelling hold, what position channels mean, and that any damage
// ends in a file or in an error that names the line.
#include <gtest/gtest.h>

#include <ctime>
#include <fstream>

#include "baker/core/file.h"
#include "io/import/bvh/bvh_character.h"
#include "io/import/character/pose.h"
#include "io/import/files/assimp_read.h"
#include "io/import/import.h"
#include "io/import/import_cache.h"
#include "tests/io_import/faults.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

const std::string k_small =
    "HIERARCHY\nROOT Hips\n{\n\tOFFSET 0 95 0\n\tCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
    "Yrotation\n\tJOINT Left Leg\n\t{\n\t\tOFFSET 10 -5 0\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation\n\t\tEnd Site\n"
    "\t\t{\n\t\t\tOFFSET 0 -40 0\n\t\t}\n\t}\n\tJOINT Left Leg\n\t{\n\t\tOFFSET -10 -5 0\n\t\tCHANNELS 1 Xrotation\n"
    "\t\tEnd Site\n\t\t{\n\t\t\tOFFSET 0 -40 0\n\t\t}\n\t}\n}\nMOTION\nFrames: 3\nFrame Time: 0.04\n"
    "0 95 0 0 0 0 10 20 30 5\n1.5 94 1 5 6 7 11 21 31 -45\n3 93.25 2 10 12 14 12 22 32 90\n";

Character read_text_as_character(const std::string& text) {
  auto file = read_bvh(text);
  EXPECT_TRUE(file) << file.error().text();
  return file ? bvh_character(std::move(*file)) : Character();
}

std::vector<Vec3> places(const Character& c, double time) {
  const ClipPose pose(c, c.clips.empty() ? nullptr : &c.clips.front());
  std::vector<Mat4> locals(c.nodes.size()), globals(c.nodes.size());
  std::vector<double> morphs;
  pose.sample(time, locals, morphs);
  globals_from_locals(c.nodes, locals, globals);
  std::vector<Vec3> out;
  for (const Mat4& m : globals) out.push_back(m.topRightCorner<3, 1>());
  return out;
}

/// Largest distance of two characters' nodes in the rest pose and over the clip; infinite where the trees differ.
double difference(const Character& a, const Character& b, bool names = true) {
  if (a.nodes.size() != b.nodes.size() || a.clips.size() != b.clips.size()) return 1e300;
  double worst = 0;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    if (a.nodes[i].parent != b.nodes[i].parent || (names && a.nodes[i].name != b.nodes[i].name)) return 1e300;
    worst = std::max(worst, (a.nodes[i].local - b.nodes[i].local).norm());
  }
  const double end = a.clips.empty() ? 0 : a.clips.front().end;
  if (!b.clips.empty() && std::abs(b.clips.front().end - end) > 1e-6) return 1e300;
  for (int k = 0; k <= 40; ++k) {
    const auto p = places(a, end * k / 40), q = places(b, end * k / 40);
    for (std::size_t i = 0; i < p.size(); ++i) worst = std::max(worst, (p[i] - q[i]).norm());
  }
  return worst;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

TEST(Bvh, Good_files_are_what_assimp_makes_of_them) {
  const auto mocap = test::assets_root() / "mocap";
  int seen = 0;
  for (const auto& file :
       {std::filesystem::path(FT_SOURCE_DIR) / "tests/data/small_shot/walker.bvh",
        mocap / "cmu_01_playground/01_01.bvh", mocap / "animateddrawings_fair1_child/dab.bvh",
        mocap / "animateddrawings_cmu_jacks/jumping_jacks.bvh", test::assimp_models_root() / "BVH/Boxing_Toes.bvh"}) {
    if (!std::filesystem::exists(file)) continue;
    ++seen;
    auto mine = read_bvh_character(file), other = read_with_assimp(file);
    ASSERT_TRUE(mine) << mine.error().text();
    ASSERT_TRUE(other) << other.error().text();
    EXPECT_EQ(mine->format, other->format);
    EXPECT_EQ(mine->file_unit, 0);
    ASSERT_EQ(mine->clips.size(), 1u);
    EXPECT_EQ(mine->clips[0].name, other->clips[0].name);
    // assimp reads floats: 1e-7 of each length and angle, adding up along a chain 200 units long.
    EXPECT_LT(difference(*mine, *other), 2e-3) << file;
    EXPECT_TRUE(check_character(*mine));
    EXPECT_FALSE(mine->contents.empty());
  }
  EXPECT_GT(seen, 0);
}

TEST(Bvh, Is_read_no_slower_than_by_assimp) {
  const auto file = test::assets_root() / "mocap/cmu_01_playground/01_03.bvh";
  FT_REQUIRE_FILE(file);
  double mine = 1e9, other = 1e9;  // CPU time, best of three
  for (int round = 0; round < 3; ++round) {
    const std::clock_t a = std::clock();
    ASSERT_TRUE(read_bvh_character(file));
    const std::clock_t b = std::clock();
    ASSERT_TRUE(read_with_assimp(file));
    const std::clock_t c = std::clock();
    mine = std::min(mine, static_cast<double>(b - a)), other = std::min(other, static_cast<double>(c - b));
  }
  std::printf("  own reader %.0f ms, assimp %.0f ms\n", 1e3 * mine / CLOCKS_PER_SEC, 1e3 * other / CLOCKS_PER_SEC);
  EXPECT_LT(mine, other);
}

TEST(Bvh, Every_spelling_of_a_file_is_the_same_file) {
  const Character c = read_text_as_character(k_small);
  ASSERT_EQ(c.nodes.size(), 5u);
  EXPECT_EQ(c.nodes[1].name, "Left Leg");
  EXPECT_EQ(c.nodes[2].name, "EndSite_Left Leg");
  EXPECT_EQ(c.nodes[3].parent, 0);
  std::string small = k_small, large = k_small;  // keywords only: names keep their case
  for (const char* word : {"HIERARCHY", "ROOT", "JOINT", "OFFSET", "CHANNELS", "MOTION", "Frames", "Frame Time",
                           "End Site", "Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"}) {
    std::string lower = word, upper = word;
    for (char& l : lower) l = static_cast<char>(std::tolower(l));
    for (char& u : upper) u = static_cast<char>(std::toupper(u));
    small = replaced(small, word, lower), large = replaced(large, word, upper);
  }
  for (const std::string& other :
       {small, large, "\xef\xbb\xbf" + k_small, replaced(k_small, "\n", "\r\n"), replaced(k_small, "\n", "\r"),
        replaced(k_small, " ", "\t"), replaced(k_small, "\t", ""), replaced(k_small, "\n", "\n\n \t"),
        replaced(k_small, "\n\t\t{", " {"), replaced(k_small, "End Site", "End Site Toe"),
        replaced(k_small, "End Site", "EndSite"), replaced(k_small, "Frames: 3", "Frames:3"),
        replaced(k_small, "Frame Time: 0.04", "Frame Time:4.0E-002"), replaced(k_small, " 95 ", " +9.5e+1 "),
        replaced(k_small, "1.5 94 1 5", "1.5\n94 1\n5"), k_small + "\n\n\x1a",
        replaced(k_small, " 1 5 6 7", " 1. 05 6.0 7")})
    // Blanks within names are theirs: where they became tabs, so did the names.
    EXPECT_EQ(difference(c, read_text_as_character(other), other.find("Left\tLeg") == std::string::npos), 0) << other;
}

TEST(Bvh, Channels_turn_in_the_order_in_which_they_stand) {
  const Character c = read_text_as_character(k_small);
  const auto turned = [](double z, double x, double y) {
    return Mat3((Eigen::AngleAxisd(z * M_PI / 180, Vec3::UnitZ()) * Eigen::AngleAxisd(x * M_PI / 180, Vec3::UnitX()) *
                 Eigen::AngleAxisd(y * M_PI / 180, Vec3::UnitY()))
                    .toRotationMatrix());
  };
  const auto at_end = places(c, 0.08);
  const Vec3 hips(3, 93.25, 2);
  const Mat3 root = turned(10, 12, 14);
  EXPECT_LT((at_end[0] - hips).norm(), 1e-12);
  const Vec3 left = hips + root * Vec3(10, -5, 0), right = hips + root * Vec3(-10, -5, 0);
  EXPECT_LT((at_end[2] - (left + root * turned(12, 22, 32) * Vec3(0, -40, 0))).norm(), 1e-11);
  EXPECT_LT((at_end[4] - (right + root * turned(0, 90, 0) * Vec3(0, -40, 0))).norm(), 1e-11);
}

TEST(Bvh, Fault_folders_play_as_their_right_twins) {
  struct Case {
    const char *name, *twin;
  };
  for (const Case& c : {Case{"bvh_same_joint_names", "unique_names.bvh"}, Case{"bvh_names_with_spaces", "unspaced.bvh"},
                        Case{"bvh_zero_offsets", "with_offsets.bvh"}, Case{"bvh_byte_order_mark", ""}}) {
    ImportRequest request = test::fault_request(c.name);
    FT_REQUIRE_FILE(request.file);
    test::ScratchFolder scratch;
    ImportRequest twin = request;
    twin.file = test::fault_folder(c.name) / c.twin;
    if (std::string(c.twin).empty()) {
      const auto text = read_text(request.file);
      ASSERT_TRUE(text && text->starts_with("\xef\xbb\xbf"));
      twin.file = scratch / "bare.bvh";
      ASSERT_TRUE(write_text_durably(twin.file, text->substr(3)));
    }
    auto a = read_bvh_character(request.file), b = read_bvh_character(twin.file);
    ASSERT_TRUE(a && b);
    EXPECT_LT(difference(*a, *b, false), 1e-9 * 174) << c.name;  // cm
    auto body = import_primary(request), right = import_primary(twin);
    ASSERT_TRUE(body) << body.error().text();
    ASSERT_TRUE(right) << right.error().text();
    ASSERT_EQ(body->trajectory->surface().vertex_count(), right->trajectory->surface().vertex_count()) << c.name;
    std::vector<Vec3> p(static_cast<std::size_t>(body->trajectory->surface().vertex_count())), q = p;
    double worst = 0;
    for (int frame = 0; frame <= 30; ++frame) {
      body->trajectory->sample(frame / 30.0, p), right->trajectory->sample(frame / 30.0, q);
      for (std::size_t v = 0; v < p.size(); ++v) worst = std::max(worst, (p[v] - q[v]).norm());
    }
    EXPECT_LT(worst, 1e-5 * 1.74) << c.name;
    EXPECT_EQ(body->info.unit_scale, 0.01) << c.name;
  }
}

TEST(Bvh, Joints_of_the_fault_folders_are_where_the_list_says) {
  int checked = 0;
  for (const char* name : {"bvh_same_joint_names", "bvh_zero_offsets"}) {
    const auto folder = test::fault_folder(name);
    FT_REQUIRE_FILE(folder);
    const auto c = read_bvh_character(folder / "motion.bvh");
    ASSERT_TRUE(c);
    std::vector<Vec3> now = places(*c, c->clips.at(0).channels.at(0).rotation.times.at(15));  // frame 16 of 1 to 31
    std::erase_if(now,
                  [&, i = std::size_t{0}](const Vec3&) mutable { return c->nodes[i++].name.starts_with("EndSite"); });
    std::ifstream in(folder / "expected.txt");
    std::vector<Vec3> expected;
    for (std::string line; std::getline(in, line);) {
      Vec3 p;
      char joint[40];
      if (line.starts_with("  ") && std::sscanf(line.c_str(), "  %39s %lf %lf %lf", joint, &p[0], &p[1], &p[2]) == 4)
        expected.push_back(p);
    }
    ASSERT_EQ(expected.size(), now.size()) << name;
    for (std::size_t i = 0; i < now.size(); ++i, ++checked)
      EXPECT_LT((now[i] - expected[i]).norm(), 9e-4) << name << " joint " << i;  // written with three decimals
  }
  EXPECT_EQ(checked, 34);
}

std::string placed(const std::string& offset, const std::string& at0, const std::string& at1) {
  std::string text = replaced(k_small, "CHANNELS 3 Zr", "CHANNELS 6 Xposition Yposition Zposition Zr");
  text = replaced(text, "OFFSET 10 -5 0", "OFFSET " + offset);
  text = replaced(text, "10 20 30 5", at0 + " 10 20 30 5");
  text = replaced(text, "11 21 31 -45", at1 + " 11 21 31 -45");
  return replaced(text, "12 22 32 90", at0 + " 12 22 32 90");
}

TEST(Bvh, Positions_stand_in_place_of_an_OFFSET_or_are_added_or_are_the_size) {
  const Character plain = read_text_as_character(k_small);
  // In place: the channels repeat the OFFSET.
  const Character same = read_text_as_character(placed("10 -5 0", "10 -5 0", "10 -5 0"));
  EXPECT_LT(difference(plain, same), 1e-12);
  EXPECT_TRUE(same.notes.empty());
  // Added: they are near 0 where the OFFSET is not.
  const Character added = read_text_as_character(placed("10 -5 0", "0 0 0", "0 0.1 0"));
  ASSERT_EQ(added.notes.size(), 1u);
  EXPECT_NE(added.notes[0].find("added"), std::string::npos);
  EXPECT_LT((places(added, 0)[1] - places(plain, 0)[1]).norm(), 1e-12);
  EXPECT_NEAR((places(added, 0.04)[1] - places(plain, 0.04)[1]).norm(), 0.1, 1e-12);
  // OFFSET 0, or one of another unit: the skeleton is the first frame's.
  for (const char* offset : {"0 0 0", "0.1 -0.05 0"}) {
    const Character sized = read_text_as_character(placed(offset, "10 -5 0", "10 -5 0"));
    EXPECT_LT(difference(plain, sized), 1e-12) << offset;
    ASSERT_EQ(sized.notes.size(), 1u) << offset;
    EXPECT_NE(sized.notes[0].find("first frame"), std::string::npos);
  }
}

TEST(Bvh, Several_roots_are_several_trees) {
  const std::size_t at = k_small.find("ROOT"), end = k_small.find("MOTION");
  std::string two = k_small.substr(0, end) + k_small.substr(at, end - at) + k_small.substr(end);
  std::string twice;
  for (std::size_t line = two.find("0 95 0 0 0 0 10"); line < two.size();) {
    const std::size_t stop = two.find('\n', line);
    twice += two.substr(line, stop - line) + " " + two.substr(line, stop - line) + "\n";
    line = stop + 1;
  }
  two = two.substr(0, two.find("0 95 0 0 0 0 10")) + twice;
  const Character c = read_text_as_character(two);
  ASSERT_EQ(c.nodes.size(), 10u);
  EXPECT_EQ(c.nodes[5].parent, -1);
  const auto p = places(c, 0.06);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(p[i], p[i + 5]);
}

TEST(Bvh, Says_in_which_line_what_is_wrong) {
  struct Case {
    std::string from, to, words;
  };
  const std::string line1 = "0 95 0 0 0 0 10 20 30 5\n", line2 = "1.5 94 1 5 6 7 11 21 31 -45\n";
  for (const Case& c :
       {Case{"HIERARCHY", "HIERACHY", "line 1"},
        Case{"ROOT Hips", "ROOT", "line 2: a ROOT has no name"},
        Case{"JOINT Left Leg\n\t{\n\t\tOFFSET 10", "JIONT Left Leg\n\t{\n\t\tOFFSET 10", "line 6: \"JIONT\""},
        Case{"OFFSET 10 -5 0", "OFFSET 10 -5", "line 9: joint \"Left Leg\""},
        Case{"OFFSET 10 -5 0", "OFFSET 10 nan 0", "line 8: joint \"Left Leg\""},
        Case{"CHANNELS 1 X", "CHANNELS 10 X", "no number of channels"},
        Case{"Zposition", "Wposition", "Wposition"},
        Case{"Yposition Zposition", "Yposition Yposition", "twice"},
        Case{"}\nMOTION", "MOTION", "is not closed"},
        Case{"}\nMOTION", "}\n}\nMOTION", "closes nothing"},
        Case{"Frames: 3", "Frames: -3", "number of frames"},
        Case{"Frames: 3", "Frames: 4", "4 frames were announced"},
        Case{"Frames: 3", "Frames: 0", "more numbers"},
        Case{"Frames: 3", "Frames: 99999999999999", "99999999999999 frames"},
        Case{"Time: 0.04", "Time: 0", "no usable frame time"},
        Case{"Time: 0.04", "Time: -0.04", "no usable frame time"},
        Case{"Time: 0.04", "Time: 1e9", "no usable frame time"},
        Case{"Time: 0.04", "Time: 30", "written 0.03333333"},
        Case{"Time: 0.04", "Time: x", "no frame time"},
        Case{line2, "1.5 94 nan 5 6 7 11 21 31 -45\n", "line 29"},
        Case{line2, "1.5 94 1,5 5 6 7 11 21 31 -45\n", "with a point"},
        Case{line2, "1.5 94 inf 5 6 7 11 21 31 -45\n", "inf"},
        Case{line2, "1.5 94 1 5 6 7 11 21 31\n", "line 29: has 9 numbers, and a frame has 10"},
        Case{line1 + line2, "0 95 0 0 0 0 10 20 30\n5 1.5 94 1 5 6 7 11 21 31 -45\n", "line 28: has 9 numbers"},
        Case{line2, "1.5 94 1 5 6 7 11 21 31 -45 0\n", "line 29: has 11 numbers"},
        Case{"HIERARCHY", std::string("\xff\xfeH\0I\0", 6), "UTF-16"},
        Case{"HIERARCHY", std::string("\0H\0I", 4), "UTF-16"}}) {
    std::string text = k_small;
    ASSERT_NE(text.find(c.from), std::string::npos) << c.from;
    text.replace(text.find(c.from), c.from.size(), c.to);
    auto file = read_bvh(text);
    ASSERT_FALSE(file) << c.to;
    EXPECT_NE(file.error().text().find(c.words), std::string::npos) << c.words << " is not in: " << file.error().text();
  }
  // Whole frames beyond those announced are left out, with a word: Debian's Boxing_Toes.bvh has one.
  const Character shorter = read_text_as_character(replaced(k_small, "Frames: 3", "Frames: 2"));
  ASSERT_EQ(shorter.notes.size(), 1u);
  EXPECT_NE(shorter.notes[0].find("holds 3 frames and announces 2"), std::string::npos);
  EXPECT_EQ(shorter.clips.at(0).end, 0.04);
  // One pose needs no frame time.
  std::string still = replaced(replaced(k_small, "Frames: 3", "Frames: 1"), "Time: 0.04", "Time: 0");
  still.resize(still.find("1.5 94"));
  EXPECT_TRUE(check_character(read_text_as_character(still)));
}

TEST(Bvh, Cut_or_changed_at_any_byte_it_is_a_character_or_a_named_error) {
  int refused = 0, read = 0;
  const auto look = [&](const std::string& text) {
    auto file = read_bvh(text, BvhSpelling::k_forget);
    if (!file) {
      ++refused;
      EXPECT_FALSE(file.error().what.empty());
      return false;
    }
    ++read;
    EXPECT_EQ(file->numbers.size(), file->frame_count * file->values_per_frame);
    const Character c = bvh_character(std::move(*file));
    const Status checked = check_character(c);  // numbers beyond 1e9 are its to refuse
    EXPECT_TRUE(checked || checked.error().what.find("1e9") != std::string::npos) << checked.error().text();
    return true;
  };
  for (const std::string& whole : {k_small, placed("0 0 0", "10 -5 0", "10 -5 0")}) {
    const std::size_t last = whole.find_last_of(' ');
    for (std::size_t size = 0; size <= last; ++size) EXPECT_FALSE(look(whole.substr(0, size))) << size;
    for (std::size_t at = 0; at < whole.size(); ++at)
      for (const char other : {'\0', '\n', ' ', '{', '}', '9', '-', '.', 'e', 'x', '\xff'}) {
        std::string text = whole;
        text[at] = other;
        look(text);
        text = whole;
        text.insert(at, 1, other);
        look(text);
      }
  }
  EXPECT_GT(refused, 2000);
  EXPECT_GT(read, 2000);
}

TEST(Bvh, Depth_and_counts_have_caps) {
  std::string deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\n", wide = deep, many = "HIERARCHY\n";
  for (int k = 0; k < 100'000; ++k) deep += "JOINT a\n{\nOFFSET 0 1 0\n";
  for (int k = 0; k < 30'000; ++k) wide += "JOINT a\n{\nOFFSET 0 1 0\n}\n";
  for (int k = 0; k < 100; ++k) many += "ROOT a\n{\nOFFSET 0 1 0\n}\n";
  for (const std::string& text : {deep, wide, many}) {
    auto file = read_bvh(text);
    ASSERT_FALSE(file);
    EXPECT_NE(file.error().what.find("more than"), std::string::npos) << file.error().text();
  }
}

TEST(Bvh, A_file_of_another_name_is_known_by_its_first_word) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text_durably(scratch / "motion.txt", "\xef\xbb\xbf \nhierarchy\n" + k_small.substr(10)));
  ASSERT_TRUE(write_text_durably(scratch / "other.txt", "HIERARCHICAL\n"));
  EXPECT_TRUE(is_bvh(scratch / "motion.txt"));
  EXPECT_FALSE(is_bvh(scratch / "other.txt"));
  EXPECT_TRUE(is_bvh(scratch / "absent.BVH"));
  const auto loaded = load_character(scratch / "motion.txt", {}, {});
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->character.nodes.size(), 5u);
}

}  // namespace
}  // namespace ft

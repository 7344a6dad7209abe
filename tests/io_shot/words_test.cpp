#include "io/shot/words.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "baker/core/random.h"
#include "io/shot/ranges.h"

namespace ft {
namespace {

TEST(Words, Stars_and_question_marks_stand_for_text_and_for_a_character) {
  EXPECT_TRUE(matches("hand_*", "Hand_R"));
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("**", "spine_03"));
  EXPECT_TRUE(matches("spine_0?", "spine_03"));
  EXPECT_TRUE(matches("*hand*", "mixamorig:LeftHandThumb1"));
  EXPECT_TRUE(matches("*a*ab", "aaaab"));
  EXPECT_FALSE(matches("", "a"));
  EXPECT_FALSE(matches("hand", "hand_r"));
  EXPECT_FALSE(matches("spine_0?", "spine_0"));
  EXPECT_FALSE(matches("*a*ab", "aaaba"));
}

TEST(Words, Distance_counts_slips_of_the_pen) {
  EXPECT_EQ(edit_distance("denim", "denim"), 0);
  EXPECT_EQ(edit_distance("denm", "denim"), 1);
  EXPECT_EQ(edit_distance("deinm", "denim"), 1);  // neighbours swapped
  EXPECT_EQ(edit_distance("Mass-Per-Area", "mass_per_area"), 0);
  EXPECT_EQ(edit_distance("", "silk"), 4);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Words, Distance_is_symmetric_and_keeps_the_triangle_with_equality_only_for_equals) {
  const std::vector<std::string> words = {"", "a", "fps", "frames", "fabric", "friction", "file", "fille", "on", "no"};
  for (const auto& a : words)
    for (const auto& b : words) {
      EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
      EXPECT_EQ(edit_distance(a, b) == 0, a == b);
    }
}

TEST(Words, Guess_is_made_only_when_it_is_near) {
  const std::vector<std::string> fabrics = {"cotton", "denim", "silk"};
  EXPECT_EQ(suggestion("cottn", fabrics), "did you mean \"cotton\"?");
  EXPECT_EQ(suggestion("heavy denim", fabrics), "did you mean \"denim\"?");
  EXPECT_EQ(suggestion("brick", fabrics), "known: cotton, denim, silk");
  EXPECT_EQ(suggestion("x", {}), "");
  EXPECT_EQ(nearest_word("on", std::vector<std::string>{"up"}), "");
}

TEST(Words, Numbers_print_short_and_read_back_to_the_same_bits) {
  EXPECT_EQ(number_text(0.15), "0.15");
  EXPECT_EQ(number_text(1e6), "1000000");
  EXPECT_EQ(number_text(1e12), "1e12");
  EXPECT_EQ(number_text(1e-6), "1e-6");
  EXPECT_EQ(number_text(-2.5e-10), "-2.5e-10");
  EXPECT_EQ(number_text(0), "0");
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const double value =
        (random_uniform({.element = i}) - 0.5) * std::pow(10.0, 40 * random_uniform({.element = i}, 1) - 20);
    EXPECT_EQ(std::strtod(number_text(value).c_str(), nullptr), value);
  }
}

TEST(Words, Text_from_outside_is_printed_without_control_characters) {
  EXPECT_EQ(printable("a\nb\x1b[31m"), "a?b?[31m");
  EXPECT_EQ(printable(std::string(100, 'x'), 5), "xxxxx...");
}

TEST(Ranges, Text_of_a_range_reads_back) {
  std::string fault;
  for (const FrameRange range :
       {FrameRange{0, 0}, FrameRange{1, 1}, FrameRange{1001, 1121}, FrameRange{0, 9'999'999}}) {
    FrameRange back;
    ASSERT_TRUE(parse_frames(frames_text(range), back, fault)) << fault;
    EXPECT_EQ(back, range);
  }
  for (std::uint64_t round = 0; round < 200; ++round) {
    std::vector<int> vertices, back;
    for (int v = 0; v < 60; ++v)
      if (random_uniform({.frame = round, .element = static_cast<std::uint64_t>(v)}) < 0.5) vertices.push_back(v);
    if (vertices.empty()) continue;
    ASSERT_TRUE(parse_vertices(vertices_text(vertices), back, fault)) << fault;
    EXPECT_EQ(back, vertices);
  }
}

TEST(Ranges, Vertices_come_out_sorted_and_once) {
  std::vector<int> out;
  std::string fault;
  ASSERT_TRUE(parse_vertices(" 7, 3-5 ,4,0 ", out, fault));
  EXPECT_EQ(out, (std::vector<int>{0, 3, 4, 5, 7}));
  for (const char* bad : {"", ",", "1,", "5-3", "-1", "1-", "a", "1 2", "0x5", "99999999999"})
    EXPECT_FALSE(parse_vertices(bad, out, fault)) << bad;
}

}  // namespace
}  // namespace ft

// Nodes of two files that are matched by name, and by the names above where names repeat.
#include "io/import/character/match_nodes.h"

#include <gtest/gtest.h>

#include "io/import/character/clips.h"

namespace ft {
namespace {

using Named = std::pair<const char*, int>;  // name, parent

Character tree(const std::vector<Named>& nodes) {
  Character out;
  for (const auto& [name, parent] : nodes) out.nodes.push_back({name, parent, Mat4::Identity(), {}});
  return out;
}

/// Both arms have "elbow" and "hand".
const std::vector<Named> k_body = {{"hips", -1}, {"left", 0},  {"elbow", 1}, {"hand", 2},
                                   {"right", 0}, {"elbow", 4}, {"hand", 5}};

TEST(Match_nodes, Names_that_repeat_go_by_the_names_above_them) {
  const Character source = tree(k_body);
  // The other arm first, a root and a clavicle more, a namespace.
  const Character target = tree({{"Armature", -1},
                                 {"rig:hips", 0},
                                 {"rig:right", 1},
                                 {"clavicle", 2},
                                 {"elbow", 3},
                                 {"hand", 4},
                                 {"rig:left", 1},
                                 {"elbow", 6},
                                 {"hand", 7}});
  const NodeMatch match = match_nodes(source, target);
  EXPECT_EQ(match.to, (std::vector<int>{1, 6, 7, 8, 2, 4, 5}));
  EXPECT_EQ(match.in_order, std::vector<char>(7, 0));
  EXPECT_EQ(match_nodes(target, source).to, (std::vector<int>{-1, 0, 4, -1, 5, 6, 1, 2, 3}));
}

TEST(Match_nodes, Of_one_that_is_there_once_the_source_with_its_path_gets_it) {
  const Character source = tree(k_body);
  const NodeMatch match = match_nodes(source, tree({{"hips", -1}, {"right", 0}, {"elbow", 1}, {"hand", 2}}));
  EXPECT_EQ(match.to, (std::vector<int>{0, -1, -1, -1, 1, 2, 3}));
  // A single hand is the same whatever is above it.
  EXPECT_EQ(match_nodes(tree({{"spine", -1}, {"hand", 0}}), tree({{"hand", -1}})).to, (std::vector<int>{-1, 0}));
}

TEST(Match_nodes, Where_no_path_is_the_same_the_most_names_upwards_decide) {
  // "left" and "right" hang elsewhere than in the other file.
  const Character source = tree({{"root", -1}, {"a", 0}, {"left", 1}, {"hand", 2}, {"right", 1}, {"hand", 4}});
  const Character target = tree({{"a", -1}, {"root", 0}, {"right", 1}, {"hand", 2}, {"left", 1}, {"hand", 4}});
  const NodeMatch match = match_nodes(source, target);
  EXPECT_EQ(match.to, (std::vector<int>{1, 0, 4, 5, 2, 3}));
  EXPECT_EQ(match.in_order, std::vector<char>(6, 0));
}

TEST(Match_nodes, What_nothing_tells_apart_goes_by_its_order_and_says_so) {
  const std::vector<Named> twins = {{"hips", -1}, {"tail", 0}, {"tail", 0}, {"tip", 2}, {"head", 0}};
  const NodeMatch match = match_nodes(tree(twins), tree(twins));
  EXPECT_EQ(match.to, (std::vector<int>{0, 1, 2, 3, 4}));
  EXPECT_EQ(match.in_order, (std::vector<char>{0, 1, 1, 0, 0}));

  Character source = tree(twins), target = tree(twins);
  Clip clip{.name = "wag"};
  for (const int node : {2, 3}) {
    Channel channel;
    channel.node = node;
    channel.translation.width = 3, channel.translation.times = {0}, channel.translation.values = {1, 2, 3};
    clip.channels.push_back(channel);
  }
  source.clips = {clip};
  std::vector<std::string> notes;
  ASSERT_TRUE(retarget_clips(source, target, "wag.fbx", notes));
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("guess: \"tail\""), std::string::npos) << notes[0];
  // Nothing is said of joints that the clip leaves alone.
  source.clips[0].channels.erase(source.clips[0].channels.begin());
  notes.clear();
  ASSERT_TRUE(retarget_clips(source, target, "wag.fbx", notes));
  EXPECT_TRUE(notes.empty()) << notes[0];
}

TEST(Match_nodes, A_hundred_thousand_nodes_of_one_name_are_matched_soon) {
  std::vector<Named> many{{"root", -1}}, chain{{"root", -1}};
  for (int k = 0; k < 100'000; ++k) many.emplace_back("bone", 0), chain.emplace_back("bone", k);
  const NodeMatch match = match_nodes(tree(many), tree(chain));
  EXPECT_EQ(match.to[1], 1);
  EXPECT_TRUE(match.in_order[2]);
}

}  // namespace
}  // namespace ft

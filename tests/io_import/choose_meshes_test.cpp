// Which meshes make the collider: those that are named, else all that the file shows.
#include "io/import/character/choose_meshes.h"

#include <gtest/gtest.h>

namespace ft {
namespace {

CharacterMesh mesh_of(const std::string& name, int node, bool visible, bool triangles = true) {
  CharacterMesh out;
  out.name = name, out.node = node, out.visible = visible;
  out.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  if (triangles) out.triangles = {{0, 1, 2}};
  return out;
}

Character four_meshes() {
  Character out;
  out.nodes = {
      {"root", -1, Mat4::Identity(), {}}, {"Body", 0, Mat4::Identity(), {}}, {"Proxy", 0, Mat4::Identity(), {}}};
  out.meshes = {mesh_of("body_shape", 1, true), mesh_of("proxy_shape", 2, false), mesh_of("proxy_hands", 2, false),
                mesh_of("curve", 0, false, false)};
  return out;
}

TEST(Choose_meshes, What_the_file_hides_is_left_out_and_named_once) {
  std::vector<std::string> notes;
  const auto chosen = choose_meshes(four_meshes(), {}, "a.fbx", notes);
  ASSERT_TRUE(chosen);
  EXPECT_EQ(*chosen, std::vector<int>{0});
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_EQ(notes[0],
            "the file hides \"Proxy\": left out of the collider; to take it in, name it: meshes = [\"Proxy\", ...]");
}

TEST(Choose_meshes, A_name_brings_in_what_is_hidden) {
  std::vector<std::string> notes;
  EXPECT_EQ(*choose_meshes(four_meshes(), {"Proxy"}, "a.fbx", notes), (std::vector<int>{1, 2}));
  EXPECT_EQ(*choose_meshes(four_meshes(), {"Body", "proxy_hands"}, "a.fbx", notes), (std::vector<int>{0, 2}));
  EXPECT_TRUE(notes.empty());
}

TEST(Choose_meshes, A_file_that_hides_everything_is_refused_with_the_names) {
  Character hidden = four_meshes();
  hidden.meshes[0].visible = false;
  std::vector<std::string> notes;
  const auto refused = choose_meshes(hidden, {}, "a.fbx", notes);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("meshes = [\"Body\", \"Proxy\"]"), std::string::npos) << refused.error().text();
}

TEST(Choose_meshes, An_unknown_name_lists_those_that_exist) {
  std::vector<std::string> notes;
  const auto refused = choose_meshes(four_meshes(), {"Bodi"}, "a.fbx", notes);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("did you mean \"Body\"?"), std::string::npos) << refused.error().text();
}

}  // namespace
}  // namespace ft

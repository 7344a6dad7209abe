// The bytes that the child process hands over and the import cache keeps: exact round trip, and every damage is
// refused.
#include <gtest/gtest.h>

#include "baker/core/random.h"
#include "io/import/character/character.h"
#include "tests/support/damage.h"

namespace ft {
namespace {

Character small_character() {
  Character c;
  c.format = "test";
  c.nodes = {{"root", -1, Mat4::Identity(), {}}, {"bone", 0, 2 * Mat4::Identity(), {0.25}}};
  c.nodes[1].local(3, 3) = 1;
  CharacterMesh mesh;
  mesh.name = "mesh", mesh.node = 1, mesh.visible = false;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.bones = {{1, Mat4::Identity()}, {0, Mat4::Identity()}};
  mesh.influence_start = {0, 1, 3, 3};
  mesh.influence_bone = {0, 0, 1};
  mesh.influence_weight = {1, 0.25, 0.75};
  mesh.morphs = {{"smile", {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}}}};
  c.meshes = {mesh};
  Channel channel;
  channel.node = 1;
  channel.rotation = {KeyInterpolation::k_step, 4, {0, 0.5}, {0, 0, 0, 1, 0, 1, 0, 0}};
  channel.weights = {KeyInterpolation::k_cubic, 1, {0.1}, {0, 1, 0}};
  c.clips = {{"walk", 0, 0.5, {channel}}};
  c.dependencies = {{"a.bin", {1, 2}}};
  c.notes = {"odd"};
  return c;
}

TEST(Character_bytes, Give_back_what_was_saved) {
  const Bytes bytes = save_character(small_character());
  const auto loaded = load_character_bytes(bytes);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(save_character(*loaded), bytes);
  EXPECT_EQ(loaded->meshes[0].morphs[0].name, "smile");
  EXPECT_FALSE(loaded->meshes[0].visible);
  EXPECT_EQ(loaded->clips[0].channels[0].rotation.interpolation, KeyInterpolation::k_step);
  EXPECT_EQ(loaded->notes, small_character().notes);
}

TEST(Character_bytes, Cut_at_any_byte_are_refused) {
  const Bytes bytes = save_character(small_character());
  test::for_each_cut(bytes, [](auto cut, std::size_t size) { EXPECT_FALSE(load_character_bytes(cut)) << size; });
}

TEST(Character_bytes, With_any_bit_flipped_are_refused) {
  const Bytes bytes = save_character(small_character());
  test::for_each_flipped_bit(
      bytes, [](const Bytes& damaged, std::size_t bit) { EXPECT_FALSE(load_character_bytes(damaged)) << bit; });
}

/// What a hostile child could write: right hash, wrong content.
TEST(Character_bytes, That_lie_are_refused_although_their_hash_is_right) {
  const Bytes honest = save_character(small_character());
  constexpr std::size_t k_head = 8 + 4 + 16 + 8;
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Bytes payload(honest.begin() + k_head, honest.end());
    const std::size_t at = random_bits({seed}, 0) % payload.size();
    payload[at] = static_cast<std::byte>(random_bits({seed}, 1) & 255);
    const Hash128 hash = hash_bytes(payload);
    ByteWriter lie;
    lie.write_raw(honest.data(), 12);
    lie.write(hash.low).write(hash.high).write(static_cast<std::uint64_t>(payload.size()));
    lie.write_raw(payload.data(), payload.size());
    const auto loaded = load_character_bytes(lie.bytes());
    if (loaded)
      EXPECT_TRUE(check_character(*loaded));
    else
      ++refused;
  }
  EXPECT_GT(refused, 300);
}

TEST(Character_check, Names_each_fault) {
  const auto fault = [](auto change) {
    Character c = small_character();
    change(c);
    const Status s = check_character(c);
    return s ? std::string() : s.error().text();
  };
  const double nan = std::nan(""), infinite = 1 / 0.0;
  EXPECT_EQ(fault([](Character&) {}), "");
  EXPECT_NE(fault([&](Character& c) { c.meshes[0].positions[1].y() = nan; }).find("vertex 1"), std::string::npos);
  EXPECT_NE(fault([&](Character& c) { c.meshes[0].positions[2].z() = infinite; }).find("vertex 2"), std::string::npos);
  EXPECT_NE(fault([](Character& c) { c.meshes[0].positions[2].z() = 1e30; }).find("vertex 2"), std::string::npos);
  EXPECT_NE(fault([](Character& c) { c.meshes[0].triangles[0][2] = 3; }), "");
  EXPECT_NE(fault([](Character& c) { c.meshes[0].triangles[0][0] = -1; }), "");
  EXPECT_NE(fault([](Character& c) { c.meshes[0].influence_bone[0] = 2; }), "");
  EXPECT_NE(fault([&](Character& c) { c.meshes[0].influence_weight[0] = nan; }), "");
  EXPECT_NE(fault([](Character& c) { c.meshes[0].influence_start[1] = 5; }), "");
  EXPECT_NE(fault([](Character& c) { c.meshes[0].influence_start.pop_back(); }), "");
  EXPECT_NE(fault([](Character& c) { c.meshes[0].morphs[0].deltas.pop_back(); }), "");
  EXPECT_NE(fault([](Character& c) { c.meshes[0].bones[1].node = 2; }), "");
  EXPECT_NE(fault([&](Character& c) { c.nodes[1].local(0, 0) = nan; }), "");
  EXPECT_NE(fault([](Character& c) { c.nodes[1].parent = 1; }), "");
  EXPECT_NE(fault([](Character& c) { c.nodes.clear(); }), "");
  EXPECT_NE(fault([](Character& c) { c.clips[0].channels[0].node = 7; }), "");
  EXPECT_NE(fault([](Character& c) { c.clips[0].channels[0].rotation.times[1] = 0; }), "");
  EXPECT_NE(fault([&](Character& c) { c.clips[0].channels[0].rotation.values[3] = nan; }), "");
  EXPECT_NE(fault([](Character& c) { c.clips[0].channels[0].rotation.width = 3; }), "");
  EXPECT_NE(fault([](Character& c) { c.file_axes *= 2; }), "");
  EXPECT_NE(fault([&](Character& c) { c.file_unit = nan; }), "");
}

}  // namespace
}  // namespace ft

// However the importing process ends, the parent gets one clear Error that names the file. The misbehaving importers
// are in main.cpp.
#include "io/import/import_child.h"

#include <gtest/gtest.h>

#include <chrono>

#include "baker/core/file.h"
#include "io/import/import_cache.h"
#include "io/reading/reading_step.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

Error import_of(const test::ScratchFolder& scratch, const std::string& name, const ImportLimits& limits = {}) {
  const auto file = scratch / name;
  EXPECT_TRUE(write_text_durably(file, "something"));
  auto character = import_in_child(file, limits);
  if (character) {
    ADD_FAILURE() << name << " was imported";
    return {};
  }
  EXPECT_EQ(character.error().where, file.string());
  EXPECT_EQ(character.error().kind, ErrorKind::k_input);
  return character.error();
}

TEST(Import_child, A_crash_is_an_error_that_says_so) {
  const test::ScratchFolder scratch;
  EXPECT_NE(import_of(scratch, "a.aborts").what.find("crashed"), std::string::npos);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_NE(import_of(scratch, "a.crashes").what.find("crashed"), std::string::npos);
#endif
}

TEST(Import_child, A_crash_names_what_was_being_read) {
  const test::ScratchFolder scratch;
  const std::string what = import_of(scratch, "a.aborts_on_a_mesh").what;
  EXPECT_NE(what.find("crashed while reading mesh \"Body\", with the test's reader (Aborted)"), std::string::npos)
      << what;
  EXPECT_NE(import_of(scratch, "a.aborts").what.find("crashed before it read anything"), std::string::npos);
  ImportLimits limits;
  limits.seconds = 1;
  const std::string stopped = import_of(scratch, "a.spins_on_a_mesh", limits).what;
  EXPECT_NE(stopped.find("while reading mesh \"Body\""), std::string::npos) << stopped;
}

TEST(Import_child, What_a_reader_throws_is_told) {
  const test::ScratchFolder scratch;
  const std::string what = import_of(scratch, "a.throws").what;
  EXPECT_NE(what.find("gave up while reading a test: too odd"), std::string::npos) << what;
}

TEST(Import_child, What_to_do_comes_through) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text_durably(scratch / "old.fbx", "; FBX 6.1.0 project file\nFBXHeaderExtension:  {\n}\n"));
  const auto refused = import_in_child(scratch / "old.fbx", {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("FBX 6.1"), std::string::npos) << refused.error().what;
  EXPECT_NE(refused.error().hint.find("FBX 7.4"), std::string::npos) << refused.error().hint;
}

TEST(Reading_step, What_is_kept_is_printable_whatever_the_file_holds) {
  const test::ScratchFolder scratch;
  EXPECT_EQ(last_reading_step(scratch / "none"), "");
  ASSERT_TRUE(write_text_durably(scratch / "damaged", "a\nb\xff c   "));
  EXPECT_EQ(last_reading_step(scratch / "damaged"), "a?b? c");
}

TEST(Import_child, A_child_that_only_computes_is_stopped_slow) {
  const test::ScratchFolder scratch;
  ImportLimits limits;
  limits.seconds = 1;
  EXPECT_NE(import_of(scratch, "a.spins", limits).what.find("stopped"), std::string::npos);
}

TEST(Import_child, A_child_that_sleeps_is_stopped_slow) {
  const test::ScratchFolder scratch;
  ImportLimits limits;
  limits.seconds = 0.1;  // wall-clock limit: four times that and 5 s
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NE(import_of(scratch, "a.sleeps", limits).what.find("too long"), std::string::npos);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(Import_child, A_child_without_memory_is_an_error) {
  const test::ScratchFolder scratch;
  EXPECT_NE(import_of(scratch, "a.exits_with_9").what.find("memory"), std::string::npos);
}

TEST(Import_child, A_missing_or_wrong_result_is_an_error) {
  const test::ScratchFolder scratch;
  import_of(scratch, "a.leaves_nothing");
  import_of(scratch, "a.writes_garbage");
  import_of(scratch, "a.glb");
  import_of(scratch, "a.bvh");
  import_of(scratch, "a.unknown_kind");
}

TEST(Import_child, A_file_that_is_not_there_is_an_error) {
  const auto loaded = load_character("/nowhere/at/all.glb", {}, {});
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().text().find("/nowhere/at/all.glb"), std::string::npos);
  EXPECT_EQ(exit_code(loaded.error().kind), 3);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

/// A limit that no child could start under: what succeeds with it came from the cache.
ImportLimits no_child() {
  ImportLimits limits;
  limits.memory_bytes = 1 << 20;
  return limits;
}

TEST(Import_cache, A_second_import_starts_no_child) {
  const auto file = test::assets_root() / "characters/cesium_man/cesium_man.gltf";
  FT_REQUIRE_FILE(file);
  const test::ScratchFolder scratch;
  ASSERT_FALSE(load_character(file, scratch / "cache", no_child())) << "the limit does not keep a child from working";
  auto first = load_character(file, scratch / "cache", {});
  ASSERT_TRUE(first) << first.error().text();
  EXPECT_FALSE(first->from_cache);
  auto second = load_character(file, scratch / "cache", no_child());
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_TRUE(second->from_cache);
  EXPECT_EQ(second->content, first->content);
  EXPECT_EQ(save_character(second->character), save_character(first->character));
}

TEST(Import_cache, A_damaged_entry_is_ignored_and_written_anew) {
  const auto file = test::assets_root() / "characters/cesium_man/cesium_man.gltf";
  FT_REQUIRE_FILE(file);
  const test::ScratchFolder scratch;
  ASSERT_TRUE(load_character(file, scratch / "cache", {}));
  const auto entry = std::filesystem::directory_iterator(scratch / "cache")->path();
  Bytes bytes = *read_file(entry);
  bytes[bytes.size() / 2] ^= std::byte{4};
  ASSERT_TRUE(write_file_durably(entry, bytes));
  EXPECT_FALSE(load_character(file, scratch / "cache", no_child()));
  auto again = load_character(file, scratch / "cache", {});
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->from_cache);
  EXPECT_TRUE(load_character(file, scratch / "cache", no_child()));
}

TEST(Import_cache, A_changed_file_that_the_character_refers_to_makes_it_stale) {
  const auto folder = test::assets_root() / "characters/kaykit_mannequin";
  FT_REQUIRE_FILE(folder / "manny_med_mod.gltf");
  const test::ScratchFolder scratch;
  std::filesystem::copy(folder, scratch / "files");
  const auto file = scratch / "files/manny_med_mod.gltf";
  auto first = load_character(file, scratch / "cache", {});
  ASSERT_TRUE(first) << first.error().text();
  ASSERT_FALSE(first->character.dependencies.empty());
  ASSERT_TRUE(load_character(file, scratch / "cache", no_child()));
  Bytes bytes = *read_file(scratch / "files/manny_med_mod.bin");
  bytes[bytes.size() / 2] ^= std::byte{1};
  ASSERT_TRUE(write_file_durably(scratch / "files/manny_med_mod.bin", bytes));
  EXPECT_FALSE(load_character(file, scratch / "cache", no_child()));
  auto changed = load_character(file, scratch / "cache", {});
  ASSERT_TRUE(changed) << changed.error().text();
  EXPECT_NE(changed->content, first->content);
}

#endif

TEST(Import_cache, A_folder_that_cannot_be_written_is_a_note) {
  const auto file = test::assets_root() / "characters/cesium_man/cesium_man.gltf";
  FT_REQUIRE_FILE(file);
  auto loaded = load_character(file, "/proc/no_such_folder", {});
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_NE(loaded->character.notes.back().find("not cached"), std::string::npos);
}

}  // namespace
}  // namespace ft

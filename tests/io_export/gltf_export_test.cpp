// What an animator relies on: what was not changed is the same to the bit, what was changed is what the importer reads
// back, and a damaged file is refused in words.
#include "io/export/gltf_export.h"

#include <gtest/gtest.h>

#include <cmath>

#include "baker/core/file.h"
#include "io/import/gltf/gltf_file.h"
#include "io/import/import_cache.h"
#include "tests/support/assets.h"
#include "tests/support/damage.h"

namespace ft {
namespace {

using gltf::GltfFile, gltf::Json;

std::vector<std::filesystem::path> sources() {
  const auto root = test::assets_root() / "characters";
  return {root / "cesium_man/cesium_man.gltf",
          root / "kaykit_mannequin/Med_MovementBasic.glb",
          root / "m2m_horse/horse-animations.glb",
          root / "mh_adult_cmu_dressed/adult_cmu01.glb",
          root / "quaternius_base_human/human-base-animations.glb",
          root / "robot_expressive/RobotExpressive.glb"};
}

Character load(const std::filesystem::path& path) {
  auto loaded = load_character(path, {}, {});
  EXPECT_TRUE(loaded) << loaded.error().text();
  return loaded ? std::move(loaded->character) : Character{};
}

bool equal(const Track& a, const Track& b) {
  return a.interpolation == b.interpolation && a.width == b.width && a.times == b.times && a.values == b.values;
}

/// The first channel of a clip with more than one key, with other values and, where asked, other times.
ChangedChannel changed(const Character& character, int clip, bool other_times) {
  for (const Channel& channel : character.clips[at(clip)].channels)
    if (channel.rotation.times.size() > 1 && channel.rotation.interpolation == KeyInterpolation::k_linear) {
      ChangedChannel out{channel.node, ChannelPath::k_rotation, channel.rotation};
      for (std::size_t k = 0; k < out.track.values.size(); k += 4) {
        const Quat q =
            Quat(Eigen::AngleAxisd(0.3, Vec3::UnitX())) *
            Quat(out.track.values[k + 3], out.track.values[k], out.track.values[k + 1], out.track.values[k + 2]);
        for (int i = 0; i < 4; ++i) out.track.values[k + at(i)] = round_to_float(q.coeffs()[i]);
      }
      if (other_times)
        out.track.times[1] = static_cast<double>(
            std::nextafter(static_cast<float>(out.track.times[1]), static_cast<float>(out.track.times[0])));
      return out;
    }
  ADD_FAILURE() << "no channel to change";
  return {};
}

TEST(GltfExport, Without_changes_a_glb_is_the_same_bytes_and_a_gltf_the_same_accessors) {
  for (const auto& path : sources()) {
    FT_REQUIRE_FILE(path);
    const Character character = load(path);
    auto out = export_glb(path, character, 0, {});
    ASSERT_TRUE(out) << out.error().text();
    if (path.extension() == ".glb") {
      EXPECT_TRUE(*out == read_file(path).value()) << path;
      continue;
    }
    test::ScratchFolder scratch;
    ASSERT_TRUE(write_file_durably(scratch / "copy.glb", *out));
    auto before = GltfFile::open(path), after = GltfFile::open(scratch / "copy.glb");
    ASSERT_TRUE(before && after);
    Json a = before->json(), b = after->json();
    const Bytes& bytes = **before->buffer(0);
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), (*after->buffer(0))->begin()));
    a.erase("buffers"), b.erase("buffers");
    EXPECT_EQ(a.dump(), b.dump());
  }
}

TEST(GltfExport, Only_the_changed_channel_is_another) {
  for (const auto& path : sources())
    for (const bool other_times : {false, true}) {
      FT_REQUIRE_FILE(path);
      SCOPED_TRACE(path.string());
      const Character character = load(path);
      const int clip = static_cast<int>(character.clips.size()) - 1;
      const ChangedChannel change = changed(character, clip, other_times);
      auto out = export_glb(path, character, clip, {&change, 1});
      ASSERT_TRUE(out) << out.error().text();
      test::ScratchFolder scratch;
      ASSERT_TRUE(write_file_durably(scratch / "out.glb", *out));

      // The file: all accessors and views that were there are, and all bytes.
      auto before = GltfFile::open(path), after = GltfFile::open(scratch / "out.glb");
      ASSERT_TRUE(before && after);
      const Json &a = before->json(), &b = after->json();
      for (const char* list : {"accessors", "bufferViews", "nodes", "meshes", "skins"})
        for (std::size_t i = 0; a.contains(list) && i < a[list].size(); ++i) EXPECT_EQ(a[list][i], b[list][i]) << list;
      EXPECT_EQ(b["accessors"].size(), a["accessors"].size() + (other_times ? 2 : 1));
      const auto length = a["buffers"][0]["byteLength"].get<std::ptrdiff_t>();
      const Bytes &old_bytes = **before->buffer(0), &new_bytes = **after->buffer(0);
      EXPECT_TRUE(std::equal(old_bytes.begin(), old_bytes.begin() + length, new_bytes.begin()));

      // What the importer reads: every track of every clip to the bit, but one.
      const Character again = load(scratch / "out.glb");
      ASSERT_EQ(again.clips.size(), character.clips.size());
      int others = 0;
      for (std::size_t c = 0; c < again.clips.size(); ++c) {
        ASSERT_EQ(again.clips[c].channels.size(), character.clips[c].channels.size());
        for (std::size_t k = 0; k < again.clips[c].channels.size(); ++k) {
          const Channel &x = character.clips[c].channels[k], &y = again.clips[c].channels[k];
          others += !equal(x.translation, y.translation) + !equal(x.scale, y.scale) + !equal(x.weights, y.weights);
          if (static_cast<int>(c) == clip && y.node == change.node)
            EXPECT_TRUE(equal(y.rotation, change.track));
          else
            others += !equal(x.rotation, y.rotation);
        }
      }
      EXPECT_EQ(others, 0);
    }
}

/// A node with a matrix that nothing moves, two buffers (one in the JSON, one beside it), a shared sampler, an image.
struct SmallFile {
  test::ScratchFolder scratch{test::ScratchFolder::k_in_memory};
  std::filesystem::path path = scratch / "small.gltf";
  Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"name": "a", "matrix": [0,2,0,0, -2,0,0,0, 0,0,2,0, 5,6,7,1], "extras": {"kept": 1.50}, "children": [1]},
              {"name": "b", "children": [2]}, {"name": "c", "mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 2}}]}],
    "images": [{"uri": "picture.PNG"}, {"uri": "lost.png"}],
    "buffers": [{"byteLength": 8, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8="},
                {"byteLength": 60, "uri": "values.bin"}],
    "bufferViews": [{"buffer": 0, "byteLength": 8}, {"buffer": 1, "byteOffset": 0, "byteLength": 24},
                    {"buffer": 1, "byteOffset": 24, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [1]},
                  {"bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3"},
                  {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"}],
    "animations": [{"name": "shared", "samplers": [{"input": 0, "output": 1, "interpolation": "STEP"}],
      "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}},
                   {"sampler": 0, "target": {"node": 2, "path": "translation"}}]}]})");
  SmallFile() {
    const std::array<float, 15> values{1, 2, 3, 4, 5, 6, 0, 0, 0, 1, 0, 0, 0, 1, 0};
    EXPECT_TRUE(write_file_durably(scratch / "values.bin", std::as_bytes(std::span(values))));
    EXPECT_TRUE(write_text_durably(scratch / "picture.PNG", "not looked into"));
    write(json.dump());
  }
  void write(const std::string& text) { EXPECT_TRUE(write_text_durably(path, text)); }
};

TEST(GltfExport, Joins_buffers_parts_a_shared_sampler_and_gives_a_matrix_node_its_parts) {
  const SmallFile small;
  const Character character = load(small.path);
  ASSERT_EQ(character.clips.size(), 1u);
  ASSERT_EQ(character.nodes.size(), 3u);
  std::vector<ChangedChannel> changes(2);
  changes[0] = {1, ChannelPath::k_translation, {KeyInterpolation::k_linear, 3, {0, 1}, {9, 8, 7, 6, 5, 4}}};
  changes[1] = {0, ChannelPath::k_translation, {KeyInterpolation::k_linear, 3, {0.5}, {5, 6, 8}}};
  auto out = export_glb(small.path, character, 0, changes);
  ASSERT_TRUE(out) << out.error().text();
  ASSERT_TRUE(write_file_durably(small.scratch / "out.glb", *out));
  auto file = GltfFile::open(small.scratch / "out.glb");
  ASSERT_TRUE(file);
  const Json& json = file->json();
  EXPECT_EQ(json["buffers"].size(), 1u);
  EXPECT_FALSE(json["buffers"][0].contains("uri"));
  int width = 0;
  EXPECT_EQ(file->accessor(1, width).value(), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(file->accessor(2, width).value(), (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(json["images"][0]["mimeType"], "image/png");
  EXPECT_EQ(json["images"][1]["uri"], "lost.png");
  std::string keys;
  for (const auto& [key, value] : json["nodes"][0].items()) keys += key + " ";
  EXPECT_EQ(keys, "name translation rotation scale extras children ");

  const Character again = load(small.scratch / "out.glb");
  const auto& channels = again.clips[0].channels;
  ASSERT_EQ(channels.size(), 3u);
  EXPECT_TRUE(equal(channels[0].translation, changes[1].track));
  EXPECT_TRUE(equal(channels[1].translation, changes[0].track));
  EXPECT_TRUE(equal(channels[2].translation, character.clips[0].channels[1].translation));  // shared it before
  EXPECT_LT((again.nodes[0].local - character.nodes[0].local).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(GltfExport, Refuses_in_words_what_contradicts_itself) {
  const auto fault = [](auto&& spoil,
                        std::vector<ChangedChannel> changes = {
                            {1, ChannelPath::k_translation, {KeyInterpolation::k_linear, 3, {0}, {9, 8, 7}}}}) {
    SmallFile small;
    const Character character = load(small.path);
    spoil(small);
    auto out = export_glb(small.path, character, 0, changes);
    return out ? std::string("no fault") : out.error().text();
  };
  const auto spoilt_json = [&](auto&& edit) {
    return fault([&](SmallFile& small) { edit(small.json), small.write(small.json.dump()); });
  };
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(has, spoilt_json([](Json& j) { j["buffers"][1]["byteLength"] = 61; }), "60 bytes of the 61");
  EXPECT_PRED2(has, spoilt_json([](Json& j) { j["buffers"][1].erase("uri"); }), "is not the first");
  EXPECT_PRED2(has, spoilt_json([](Json& j) { j["bufferViews"][1]["buffer"] = 2; }), "a bufferView has no buffer");
  EXPECT_PRED2(has, spoilt_json([](Json& j) { j["nodes"][1].erase("children"); }), "nodes are not those");
  EXPECT_PRED2(has, spoilt_json([](Json& j) { j["animations"].clear(); }), "animations are not the clips");
  EXPECT_PRED2(has, spoilt_json([](Json& j) { j["animations"][0]["samplers"].clear(); }), "sampler does not exist");
  EXPECT_PRED2(has, fault([](SmallFile& s) { std::filesystem::remove(s.scratch / "values.bin"); }), "values.bin");
  EXPECT_PRED2(has, fault([](SmallFile& s) { s.write("{"); }), "cannot be read");
  const auto refused = [&](ChangedChannel change) { return fault([](SmallFile&) {}, {std::move(change)}); };
  const Track good{KeyInterpolation::k_linear, 3, {0}, {9, 8, 7}};
  EXPECT_PRED2(has, refused({9, ChannelPath::k_translation, good}), "node 9");
  EXPECT_PRED2(has, refused({1, ChannelPath::k_rotation, good}), "do not match");
  EXPECT_PRED2(has, refused({1, ChannelPath::k_scale, {KeyInterpolation::k_linear, 3, {0}, {9, 8, 1e300}}}),
               "not a finite");
  EXPECT_PRED2(has,
               refused({1, ChannelPath::k_scale, {KeyInterpolation::k_linear, 3, {1, 1 + 1e-12}, {1, 1, 1, 1, 1, 1}}}),
               "do not ascend");
}

TEST(GltfExport, Damaged_files_end_in_a_file_or_a_named_error) {
  const SmallFile small;
  const Character character = load(small.path);
  const ChangedChannel change{1, ChannelPath::k_translation, {KeyInterpolation::k_linear, 3, {0}, {9, 8, 7}}};
  int refused = 0;
  const auto attempt = [&](const std::filesystem::path& path) {
    auto out = export_glb(path, character, 0, {&change, 1});
    refused += !out && !out.error().what.empty();
  };
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    ASSERT_TRUE(write_text_durably(small.scratch / "damaged.gltf",
                                   test::damaged(small.json.dump(), {.alphabet = "{}[]\",:0-9e5"}, seed)));
    attempt(small.scratch / "damaged.gltf");
  }
  EXPECT_GT(refused, 100);
  // A .glb that is cut anywhere lacks bytes of its only buffer.
  const auto whole = export_glb(small.path, character, 0, {});
  ASSERT_TRUE(whole);
  refused = 0;
  int cuts = 0;
  test::for_each_cut(whole.value(), [&](std::span<const std::byte> bytes, std::size_t size) {
    if (size % 7 != 0) return;
    ++cuts;
    ASSERT_TRUE(write_file_durably(small.scratch / "cut.glb", bytes));
    attempt(small.scratch / "cut.glb");
  });
  EXPECT_EQ(refused, cuts);
}

}  // namespace
}  // namespace ft

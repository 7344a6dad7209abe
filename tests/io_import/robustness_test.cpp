// Any file in ends in a character or a named error, within the limits, and nothing that is not finite gets through:
// Debian's assimp-testmodels (malformed ones among them), and seeded mutations and cuts of good files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>

#include "baker/core/file.h"
#include "baker/core/parallel.h"
#include "baker/core/random.h"
#include "io/import/import.h"
#include "tests/support/assets.h"
#include "tests/support/sanitized.h"

namespace ft {
namespace {

struct Tally {
  int loaded = 0, refused = 0, stopped = 0, bodies = 0;
  std::vector<std::string> faults;
};

constexpr std::uint64_t k_most_memory = std::uint64_t{2} << 30;

/// Imports with every chance given (own unit, any size) and looks at everything that comes out.
void try_file(const std::filesystem::path& file, double seconds, Tally& tally, std::uint64_t memory = k_most_memory) {
  ImportRequest request;
  request.file = file;
  request.unit_scale = 1;
  request.limits.seconds = seconds;
  request.limits.memory_bytes = memory;
  auto primary = import_primary(request);
  if (!primary) {
    const Error& error = primary.error();
    ++tally.refused;
    if (error.what.find("crashed") != std::string::npos || error.what.find("stopped") != std::string::npos ||
        error.what.find("memory") != std::string::npos) {
      ++tally.stopped;
      std::printf("  stopped: %s\n", error.text().c_str());
    }
    // Neither a refusal nor a crash: something that escaped in the child, or a sanitizer's report (then it stands
    // above).
    if (error.what.find("ended with code") != std::string::npos) tally.faults.push_back(error.text());
    if (error.where.empty() || error.what.empty()) tally.faults.push_back("no name in: " + error.text());
    return;
  }
  ++tally.loaded;
  const Trajectory& t = *primary->trajectory;
  const Surface& surface = t.surface();
  const int n = surface.vertex_count();
  for (const Triangle& triangle : surface.triangles)
    for (const int v : triangle)
      if (v < 0 || v >= n) tally.faults.push_back(file.string() + ": triangle out of range");
  for (const int part : surface.part_of_vertex)
    if (part < 0 || part >= static_cast<int>(surface.parts.size())) {
      tally.faults.push_back(file.string() + ": part out of range");
      break;
    }
  std::vector<Vec3> positions(static_cast<std::size_t>(n));
  t.bind_pose(positions);
  if (!all_finite(positions)) tally.faults.push_back(file.string() + ": bind pose not finite");
  for (const double time : {-1.0, -0.5, 0.0, 0.37}) {
    t.sample(time, positions);
    if (!all_finite(positions)) tally.faults.push_back(file.string() + ": sample not finite");
  }
}

void report(const char* what, const Tally& tally) {
  std::printf("  %s: %d loaded, %d refused (%d of them crashed, timed out or ran out of memory in the child)\n", what,
              tally.loaded, tally.refused, tally.stopped);
  for (const std::string& fault : tally.faults) ADD_FAILURE() << fault;
}

TEST(Robustness, Every_model_of_assimps_tests_loads_or_is_refused_slow) {
  const auto root = test::assimp_models_root();
  FT_REQUIRE_FILE(root);
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  Tally tally;
  const std::size_t step = test::every(5, "models");
  for (std::size_t k = 0; k < files.size(); k += step) try_file(files[k], test::k_sanitized ? 60 : 10, tally);
  report("assimp models", tally);
  EXPECT_GT(tally.loaded, static_cast<int>(100 / step));
}

/// Flips, overwrites, cuts, repeats; what happens is a function of the seed.
Bytes mutate(Bytes bytes, std::uint64_t seed) {
  const auto draw = [&](std::uint64_t k, std::uint64_t range) { return random_bits({seed, 1, 2, 3}, k) % range; };
  if (bytes.empty()) return bytes;
  const auto kind = draw(0, 5);
  if (kind == 0) {
    bytes.resize(draw(1, bytes.size()));
    return bytes;
  }
  // Half of the mutations go to the head of the file, where lengths and counts live.
  const std::size_t reach = draw(1, 2) == 0 ? std::min<std::size_t>(bytes.size(), 4096) : bytes.size();
  const auto count = 1 + draw(2, draw(3, 3) == 0 ? 24 : 2);
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::size_t at = draw(10 + 3 * k, reach);
    if (kind == 1) bytes[at] ^= static_cast<std::byte>(1u << draw(11 + 3 * k, 8));
    if (kind == 2) bytes[at] = static_cast<std::byte>(draw(11 + 3 * k, 256));
    if (kind == 3) bytes[at] = draw(11 + 3 * k, 2) == 0 ? std::byte{0xff} : std::byte{0};
    if (kind == 4) std::swap(bytes[at], bytes[draw(12 + 3 * k, bytes.size())]);
  }
  return bytes;
}

/// Mutants of the files that are there, `count` in all, each file with about as many.
int try_mutants(const std::vector<std::filesystem::path>& files, std::uint64_t count, std::uint64_t step,
                std::uint64_t memory, Tally& tally) {
  const test::ScratchFolder scratch;
  std::vector<std::pair<std::filesystem::path, Bytes>> good;
  for (const auto& file : files)
    if (auto bytes = read_file(file)) good.emplace_back(file, std::move(*bytes));
  int tried = 0;
  if (good.empty()) return tried;
  for (std::uint64_t k = 0; k < count; k += step) {
    const auto& [file, bytes] = good[k % good.size()];
    const auto path = scratch / ("mutant_" + std::to_string(k) + file.extension().string());
    EXPECT_TRUE(write_file_durably(path, mutate(bytes, (k / good.size()) * 977 + bytes.size())));
    const std::size_t faults = tally.faults.size();
    try_file(path, test::k_sanitized ? 60 : 10, tally, memory);
    if (tally.faults.size() > faults)
      tally.faults.back() += " (mutant " + std::to_string(k) + ", of " + file.string() + ")";
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    ++tried;
  }
  EXPECT_EQ(tally.loaded + tally.refused, tried);
  EXPECT_GT(tally.loaded, tried / 20) << "mutations that nothing survives test little";
  return tried;
}

/// Formats with a reader or a check of ours, and files of each: small ones, where a change hits what counts, and one
/// of a usual size.
struct ReadFormat {
  const char* name;
  std::vector<std::filesystem::path> files;
};

std::vector<ReadFormat> read_formats() {
  const auto root = test::assets_root(), faults = root / "faults", characters = root / "characters";
  const auto models = test::assimp_models_root(), fbx = models / "FBX";
  return {{"glTF",
           {characters / "cesium_man/cesium_man.gltf", models / "glTF2/simple_skin/simple_skin.gltf",
            models / "glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf"}},
          {"GLB",
           {faults / "gltf_weights_ubyte/w8.glb", faults / "gltf_quantized/gp.glb",
            faults / "gltf_sparse_step_animation/sanimstep.glb", faults / "gltf_one_mesh_two_skins/shared_unique.glb",
            models / "glTF2/RiggedSimple-glTF-Binary/RiggedSimple.glb",
            characters / "robot_expressive/RobotExpressive.glb"}},
          {"binary FBX",
           {fbx / "huesitos.fbx", fbx / "box.fbx", fbx / "phong_cube.fbx", fbx / "boxWithCompressedCTypeArray.FBX",
            fbx / "animation_with_skeleton.fbx", characters / "ozz_pab_fbx/skeleton.fbx"}},
          {"FBX in text",
           {faults / "fbx_cubic/cubic.fbx", faults / "fbx_layers/layers.fbx", faults / "fbx_morph/morph.fbx",
            faults / "fbx_dual_quaternion/dq.fbx", faults / "fbx_inherit/inherit.fbx",
            fbx / "cubes_with_mirroring_and_pivot.fbx"}},
          {"Collada",
           {faults / "dae_step/d_step.dae", models / "Collada/box_nested_animation.dae",
            models / "Collada/cube_with_2UVs.DAE", models / "Collada/ConcavePolygon.dae",
            characters / "ozz_pab_fbx/skeleton.dae"}},
          {"BVH",
           {faults / "bvh_same_joint_names/motion.bvh", faults / "bvh_names_with_spaces/motion.bvh",
            faults / "bvh_byte_order_mark/motion.bvh", faults / "bvh_zero_offsets/with_offsets.bvh",
            root / "mocap/animateddrawings_cmu_jacks/jumping_jacks.bvh"}}};
}

// 6 * 190 = 1,140. A damaged file must not take a child with it, nor more time or memory than a few times its size
// explains: the largest file is 1.7 MB, and reading it as it is takes a tenth of the memory allowed here.
TEST(Robustness, Mutants_of_formats_with_a_reader_of_ours_load_or_are_refused_slow) {
  constexpr std::uint64_t k_each = 190, k_memory = std::uint64_t{512} << 20;
  int tried = 0;
  for (const ReadFormat& format : read_formats()) {
    Tally tally;
    tried += try_mutants(format.files, k_each, 1, k_memory, tally);
    report(format.name, tally);
    EXPECT_EQ(tally.stopped, 0) << format.name;
  }
  if (tried == 0) GTEST_SKIP() << "skipped: no good file present";
  std::printf("  %d mutants in all\n", tried);
}

TEST(Robustness, Mutants_of_other_formats_load_or_are_refused_slow) {
  const auto models = test::assimp_models_root();
  Tally tally;
  const int tried = try_mutants({models / "X/anim_test.x", models / "MD5/SimpleCube.md5mesh"}, 80,
                                test::every(5, "mutations"), k_most_memory, tally);
  if (tried == 0) GTEST_SKIP() << "skipped: no good file present";
  report("other formats", tally);
}

}  // namespace
}  // namespace ft

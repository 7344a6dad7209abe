// Public glTF files against three.js: every corner of every triangle in the rest pose and at six times of each clip.
// Runs where the files and their reference are: the folder in FOLLOWTHROUGH_GLTF_SWEEP, with gltf_sweep_reference.mjs
// run over it. A file that comes in differently has to say so in a note.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "baker/core/file.h"
#include "io/import/character/pose.h"
#include "io/import/gltf/gltf_read.h"

namespace ft {
namespace {

struct Sample {
  int clip = -1;
  double time = 0;
  std::vector<Vec3> corners;
};

std::vector<Sample> read_reference(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  std::vector<Sample> out;
  if (!bytes) return out;
  ByteReader in(*bytes);
  const auto count = in.read<std::uint32_t>();
  for (std::uint32_t s = 0; s < count && in.ok(); ++s) {
    Sample sample;
    sample.clip = in.read<std::int32_t>(), sample.time = in.read<double>();
    const auto corner_count = in.read<std::uint32_t>();
    const auto values = in.read_array<float>(std::uint64_t{3} * corner_count);
    for (std::size_t i = 0; i + 2 < values.size(); i += 3)
      sample.corners.push_back(Vec3f(values[i], values[i + 1], values[i + 2]).cast<double>());
    out.push_back(std::move(sample));
  }
  return out;
}

/// The corners of all triangles, by the definition of skinning in the specification.
std::vector<Vec3> corners(const Character& character, int clip, double time) {
  const ClipPose pose(character, clip < 0 ? nullptr : &character.clips[static_cast<std::size_t>(clip)]);
  std::vector<Mat4> locals(character.nodes.size()), globals(locals.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  globals_from_locals(character.nodes, locals, globals);
  std::vector<Vec3> out;
  for (const CharacterMesh& mesh : character.meshes) {
    std::vector<Vec3> moved(mesh.positions.size());
    for (std::size_t v = 0; v < moved.size(); ++v) {
      Vec3 p = mesh.positions[v];
      const auto first = static_cast<std::size_t>(pose.morph_start()[static_cast<std::size_t>(mesh.node)]);
      for (std::size_t m = 0; m < mesh.morphs.size(); ++m) p += morphs[first + m] * mesh.morphs[m].deltas[v];
      Vec3 sum = Vec3::Zero();
      const bool rigid = mesh.bones.empty() || mesh.influence_start[v] == mesh.influence_start[v + 1];
      if (rigid)
        sum = (globals[static_cast<std::size_t>(mesh.node)] * p.homogeneous()).head<3>();
      else
        for (int k = mesh.influence_start[v]; k < mesh.influence_start[v + 1]; ++k) {
          const SkinBone& bone = mesh.bones[static_cast<std::size_t>(mesh.influence_bone[static_cast<std::size_t>(k)])];
          const Mat4 m = globals[static_cast<std::size_t>(bone.node)] * bone.inverse_bind;
          sum += mesh.influence_weight[static_cast<std::size_t>(k)] * (m * p.homogeneous()).head<3>();
        }
      moved[v] = sum;
    }
    for (const Triangle& t : mesh.triangles)
      for (const int v : t) out.push_back(moved[static_cast<std::size_t>(v)]);
  }
  return out;
}

/// Largest distance of corners, as a share of the box's diagonal; the first corner of a triangle may be any of three.
double difference(const std::vector<Vec3>& ours, const std::vector<Vec3>& theirs) {
  if (ours.size() != theirs.size()) return std::numeric_limits<double>::infinity();
  Box box = bounds(theirs);
  const double scale = theirs.empty() ? 1 : std::max(box.size().norm(), 1e-6 * box.lo.cwiseAbs().maxCoeff());
  double worst = 0;
  for (std::size_t t = 0; t + 2 < ours.size(); t += 3) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t turn = 0; turn < 3; ++turn) {
      double most = 0;
      for (std::size_t k = 0; k < 3; ++k) most = std::max(most, (ours[t + (k + turn) % 3] - theirs[t + k]).norm());
      least = std::min(least, most);
    }
    worst = std::max(worst, least);
  }
  return worst == 0 ? 0 : scale > 0 ? worst / scale : worst;
}

/// Kinds of features in a file, by words of its JSON.
std::vector<std::string> features(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  std::vector<std::string> out{"all"};
  if (!bytes) return out;
  const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  for (const auto& [word, name] : {std::pair{"\"skins\"", "skins"},
                                   {"\"targets\"", "morph targets"},
                                   {"\"animations\"", "animations"},
                                   {"CUBICSPLINE", "cubic splines"},
                                   {"\"STEP\"", "steps"},
                                   {"\"sparse\"", "sparse accessors"},
                                   {"KHR_draco_mesh_compression", "draco"},
                                   {"meshopt_compression", "meshopt"},
                                   {"KHR_mesh_quantization", "quantized"},
                                   {"EXT_mesh_gpu_instancing", "instances"},
                                   {"JOINTS_1", "8 influences"},
                                   {"\"normalized\"", "normalized integers"}})
    if (text.find(word) != std::string_view::npos) out.push_back(name);
  return out;
}

TEST(GltfSweep, Public_files_are_as_three_js_has_them_or_say_why_not_slow) {
  const char* folder = std::getenv("FOLLOWTHROUGH_GLTF_SWEEP");
  if (folder == nullptr) GTEST_SKIP() << "skipped: no folder of glTF files in FOLLOWTHROUGH_GLTF_SWEEP";
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".positions") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  struct Row {
    int right = 0, noted = 0, silent = 0, refused = 0, both_refuse = 0, only_ours = 0;
  };
  std::map<std::string, Row> table;
  for (const auto& reference : files) {
    const std::filesystem::path file = reference.parent_path() / reference.stem();
    const std::vector<Sample> samples = read_reference(reference);
    auto character = read_gltf(file);
    Status checked = character ? check_character(*character) : Status(character.error());
    int Row::*kind = &Row::right;
    if (!checked) {
      kind = samples.empty() ? &Row::both_refuse : &Row::refused;
      if (!samples.empty()) std::printf("  refused: %s: %s\n", file.c_str(), checked.error().text().c_str());
    } else if (samples.empty()) {
      kind = &Row::only_ours;
    } else {
      double worst = 0;
      int clip = -1;
      for (const Sample& s : samples) {
        const bool known = s.clip < static_cast<int>(character->clips.size());
        const double d = known ? difference(corners(*character, s.clip, s.time), s.corners)
                               : std::numeric_limits<double>::infinity();
        if (!(d <= worst)) worst = std::isnan(d) ? std::numeric_limits<double>::infinity() : d, clip = s.clip;
      }
      if (worst > 1e-5) {
        kind = character->notes.empty() ? &Row::silent : &Row::noted;
        std::printf("  %s: %s: %.3g of the diagonal in clip %d\n", character->notes.empty() ? "SILENT" : "noted",
                    file.c_str(), worst, clip);
        for (const std::string& note : character->notes) std::printf("      %s\n", note.c_str());
      }
    }
    for (const std::string& feature : features(file)) ++(table[feature].*kind);
  }
  std::printf("  %-20s %6s %6s %6s %8s %12s %10s\n", "kind", "right", "noted", "silent", "refused", "both refuse",
              "only ours");
  for (const auto& [feature, row] : table)
    std::printf("  %-20s %6d %6d %6d %8d %12d %10d\n", feature.c_str(), row.right, row.noted, row.silent, row.refused,
                row.both_refuse, row.only_ours);
  EXPECT_GT(table["all"].right, 0);
  EXPECT_EQ(table["all"].silent, 0);
}

}  // namespace
}  // namespace ft

// A sweep over public FBX and OBJ files against a reference reader that is no part of the project: no file may come in
// wrong without a word.
// $FOLLOWTHROUGH_SWEEP names a folder with data/ (the files) and out/NAME.txt (where the reference has the points that
// faces use): "pose TIME COUNT VISIBLE BEGIN END", "clip NAME", "node NAME", then a line "x y z" for each point, in the
// file's own units and axes; one such block for each mesh, first for the rest pose (clip "(rest)"), then for times of
// each clip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <unordered_map>

#include "io/import/body/skin.h"
#include "io/import/character/pose.h"
#include "io/import/files/read_geometry_cache.h"
#include "io/import/import_cache.h"
#include "tests/support/assets.h"

namespace ft {
namespace {

struct Pose {
  double time = 0;
  std::string clip;
  std::vector<Vec3> points;  // of all meshes that are visible at rest
};

/// Points of equal clip and time together. A file without a point gives none. Visibility is that of the rest pose: what
/// appears or vanishes by animation is a note.
std::vector<Pose> reference_poses(const std::filesystem::path& file) {
  std::vector<Pose> out;
  std::vector<char> shown;  // by the order of blocks within a pose
  std::size_t block = 0;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    double time = 0, begin = 0, end = 0;
    std::size_t count = 0;
    int visible = 0;
    if (std::sscanf(line.c_str(), "pose %lf %zu %d %lf %lf", &time, &count, &visible, &begin, &end) != 5) continue;
    std::string clip, node;
    std::getline(in, clip), std::getline(in, node);
    clip = clip.substr(5);
    if (out.empty() || out.back().time != time || out.back().clip != clip) out.push_back({time, clip, {}}), block = 0;
    if (out.size() == 1) shown.push_back(static_cast<char>(visible));
    for (std::size_t k = 0; k < count && std::getline(in, line); ++k) {
      Vec3 p = Vec3::Zero();
      std::sscanf(line.c_str(), "%lf %lf %lf", &p[0], &p[1], &p[2]);
      if (block < shown.size() && shown[block] != 0) out.back().points.push_back(p);
    }
    ++block;
  }
  return out;
}

/// Share of a's points that have none of b's within the distance.
double unmatched(const std::vector<Vec3>& a, const std::vector<Vec3>& b, double distance) {
  using Cell = std::array<long, 3>;
  const auto cell = [&](const Vec3& p) {
    return Cell{std::lround(p.x() / distance), std::lround(p.y() / distance), std::lround(p.z() / distance)};
  };
  std::map<Cell, std::vector<int>> grid;
  for (std::size_t i = 0; i < b.size(); ++i) grid[cell(b[i])].push_back(static_cast<int>(i));
  const auto near = [&](const Vec3& p) {
    const Cell c = cell(p);
    for (long x = -1; x <= 1; ++x)
      for (long y = -1; y <= 1; ++y)
        for (long z = -1; z <= 1; ++z)
          if (const auto found = grid.find({c[0] + x, c[1] + y, c[2] + z}); found != grid.end())
            for (const int i : found->second)
              if ((b[static_cast<std::size_t>(i)] - p).norm() <= distance) return true;
    return false;
  };
  const auto missing = std::count_if(a.begin(), a.end(), [&](const Vec3& p) { return !p.allFinite() || !near(p); });
  return a.empty() ? 0 : static_cast<double>(missing) / static_cast<double>(a.size());
}

std::vector<Vec3> points_of(const Character& character, const std::string& clip_name, double time,
                            std::vector<std::string>& notes) {
  const Clip* clip = nullptr;
  for (const Clip& c : character.clips)
    if (c.name == clip_name) clip = &c;
  const ClipPose pose(character, clip);
  std::vector<Mat4> locals(character.nodes.size()), globals(character.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  globals_from_locals(character.nodes, locals, globals);
  std::vector<Vec3> out;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) {
    if (!character.meshes[m].visible) continue;
    std::vector<std::string> welded;
    const Skin skin = weld(character, {static_cast<int>(m)}, welded);
    // What has no area is no part of the body, and its points are not met.
    for (std::string& note : welded)
      if (note.find("without area") != std::string::npos) notes.push_back(std::move(note));
    std::vector<Vec3> points(skin.base.size());
    deform(skin, Mat4::Identity(), globals, morphs, points);
    out.insert(out.end(), points.begin(), points.end());
  }
  return out;
}

struct Verdict {
  std::string word;  // "right", "refused", "wrong, noted", "SILENT"
  std::string why;
};

double size_of(const std::vector<Vec3>& points) {
  return points.empty() ? 0 : bounds(points).size().norm();
}

Verdict judge_character(const std::filesystem::path& file, const std::vector<Pose>& poses) {
  if (poses.empty()) return {"not compared", "the reference has no points"};
  const auto loaded = load_character(file, {}, {});
  if (!loaded) return {"refused", loaded.error().text()};
  const Character& character = loaded->character;
  double size = 0;
  for (const Pose& pose : poses) size = std::max(size, size_of(pose.points));
  std::string why;
  std::vector<std::string> notes = character.notes;
  for (const Pose& pose : poses) {
    notes = character.notes;
    const std::vector<Vec3> ours = points_of(character, pose.clip, pose.time, notes);
    // A millionth of how far out the points are: what the reference's nine digits resolve.
    double out_there = 0;
    for (const Vec3& p : pose.points) out_there = std::max(out_there, p.cwiseAbs().maxCoeff());
    const double bar = std::max({1e-4 * size, 1e-8 * out_there, 1e-12});
    const double lost = unmatched(pose.points, ours, bar), extra = unmatched(ours, pose.points, bar);
    if (lost > 0 || extra > 0) {
      char text[200];
      std::snprintf(text, sizeof text, "clip %s at %.4g s: %.0f %% of %zu points not met, %.0f %% of %zu too many",
                    pose.clip.c_str(), pose.time, 100 * lost, pose.points.size(), 100 * extra, ours.size());
      why = text;
      break;
    }
  }
  if (why.empty()) return {"right", ""};
  for (const std::string& note : notes) why += "; note: " + note;
  return {notes.empty() ? "SILENT" : "wrong, noted", why};
}

Verdict judge_obj(const std::filesystem::path& file, const std::vector<Pose>& poses) {
  const test::ScratchFolder alone;  // a number in its name makes it one of a sequence with those beside it
  std::filesystem::copy_file(file, alone / "shape.obj");
  const auto cache = read_geometry_cache(alone / "shape.obj", {}, 24, false);
  if (!cache) return {"refused", cache.error().text()};
  std::vector<char> used(static_cast<std::size_t>(cache->vertex_count), 0);
  for (const Triangle& t : triangulate(cache->mesh))
    for (const int v : t) used[static_cast<std::size_t>(v)] = 1;
  std::vector<Vec3> ours, theirs;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) ours.push_back(cache->sample(0)[v].cast<double>());
  if (!poses.empty()) theirs = poses.front().points;
  const double bar = std::max(1e-4 * size_of(theirs), 1e-12);
  const double lost = unmatched(theirs, ours, bar), extra = unmatched(ours, theirs, bar);
  if (lost == 0 && extra == 0) return {"right", ""};
  std::string why = std::to_string(lost) + " not met, " + std::to_string(extra) + " too many";
  for (const std::string& note : cache->notes) why += "; note: " + note;
  return {cache->notes.empty() ? "SILENT" : "wrong, noted", why};
}

/// By what the name of a file says that it is about.
std::string kind_of(const std::string& name) {
  const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
  if (has(".obj")) return "OBJ";
  if (has("cache")) return "geometry caches";
  if (has("blend_shape") || has("morph") || has("blend_inbetween")) return "blend shapes";
  if (has("skin") || has("dq_") || has("dual_quat")) return "skins";
  if (has("anim") || has("interpolation") || has("resample") || has("curve") || has("tangent") || has("extrapolation"))
    return "animation";
  if (has("constraint") || has("_ik") || has("aim")) return "constraints";
  if (has("pivot") || has("inherit") || has("geometry_transform") || has("transform") || has("rotation") ||
      has("scale") || has("mirror") || has("units") || has("axes"))
    return "transforms";
  if (has("lod") || has("nurbs") || has("subsurf") || has("subdiv")) return "LOD, NURBS, subdivision";
  if (has("synthetic")) return "synthetic, odd or damaged";
  return "meshes and the rest";
}

TEST(FbxSweep, No_public_file_comes_in_wrong_without_a_word_slow) {
  const char* given = std::getenv("FOLLOWTHROUGH_SWEEP");
  if (given == nullptr) GTEST_SKIP() << "skipped: $FOLLOWTHROUGH_SWEEP does not name a folder of reference files";
  const std::filesystem::path root = given;
  std::map<std::string, std::map<std::string, int>> table;
  std::map<std::string, int> total;
  std::vector<std::filesystem::path> references;
  for (const auto& entry : std::filesystem::directory_iterator(root / "out"))
    if (entry.path().extension() == ".txt") references.push_back(entry.path());
  ASSERT_FALSE(references.empty());
  std::sort(references.begin(), references.end());
  const char* only = std::getenv("FOLLOWTHROUGH_SWEEP_ONLY");
  for (const auto& reference : references) {
    const std::string name = reference.stem().string();
    if (only != nullptr && name.find(only) == std::string::npos) continue;
    const auto file = root / "data" / name;
    const auto poses = reference_poses(reference);
    const Verdict verdict = file.extension() == ".obj" ? judge_obj(file, poses) : judge_character(file, poses);
    ++table[kind_of(name)][verdict.word], ++total[verdict.word];
    if (verdict.word != "right") std::printf("%-14s %s: %s\n", verdict.word.c_str(), name.c_str(), verdict.why.c_str());
    EXPECT_NE(verdict.word, "SILENT") << name << ": " << verdict.why;
  }
  std::printf("%-28s %6s %8s %13s %7s %13s\n", "kind", "right", "refused", "wrong, noted", "SILENT", "not compared");
  table["together"] = total;
  for (auto& [kind, counts] : table)
    std::printf("%-28s %6d %8d %13d %7d %13d\n", kind.c_str(), counts["right"], counts["refused"],
                counts["wrong, noted"], counts["SILENT"], counts["not compared"]);
}

}  // namespace
}  // namespace ft

// What counts as a teleport: jumps without a motion that leads there; and what never does: everything quick that bodies
// really do.
#include "io/import/repair/teleport_scan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "io/import/import.h"
#include "tests/support/assets.h"
#include "tests/support/scripted_body.h"

namespace ft {
namespace {

using Path = std::function<Eigen::Isometry3d(double)>;

Eigen::Isometry3d placed(const Vec3& to, double turn = 0) {
  return Eigen::Translation3d(to) * Eigen::AngleAxisd(turn, Vec3::UnitY());
}

/// A body of 1.8 m: trunk, head, and one leg that goes its own way beside it. Times are s from the first frame.
ScriptedBody person(const Path& trunk, const Path& leg) {
  Surface surface;
  std::vector<Vec3> points;
  const auto add = [&](const char* name, const Vec3& middle, const Vec3& shape, int parent) {
    const std::size_t first = points.size();
    make_sphere(1, 8, 12, points, surface.triangles);
    for (std::size_t i = first; i < points.size(); ++i) points[i] = middle + points[i].cwiseProduct(shape);
    surface.part_of_vertex.resize(points.size(), static_cast<int>(surface.parts.size()));
    surface.parts.push_back({name, parent, shape.prod()});
  };
  add("trunk", Vec3(0, 1.1, 0), Vec3(0.2, 0.4, 0.15), -1);
  add("head", Vec3(0, 1.65, 0), Vec3(0.1, 0.15, 0.1), 0);
  add("leg", Vec3(0.1, 0.4, 0), Vec3(0.08, 0.4, 0.08), 0);
  auto parts = surface.part_of_vertex;
  return ScriptedBody(std::move(surface), points, 0, [trunk, leg, parts](double time, std::span<Vec3> x) {
    const Eigen::Isometry3d body = trunk(time), limb = body * leg(time);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = (parts[i] == 2 ? limb : body) * x[i];
  });
}

Path still() {
  return [](double) { return Eigen::Isometry3d::Identity(); };
}

TeleportScan scan(const Path& trunk, const Path& leg = still(), double fps = 25) {
  TeleportScanSettings settings;
  settings.first_frame = 1001, settings.last_frame = 1050, settings.fps = fps;
  return scan_teleports(person(trunk, leg), settings);
}

void expect_nothing(const TeleportScan& found, const std::string& what) {
  for (const std::string& note : teleport_notes(found, what)) ADD_FAILURE() << note;
}

TEST(TeleportScan, finds_a_jump_of_3_m_and_measures_it_exactly) {
  const auto jump = placed(Vec3(3, 0, 0));
  for (const double speed : {0.0, 4.0}) {
    const auto found = scan(
        [&](double t) { return (t > 0.79 ? jump : Eigen::Isometry3d::Identity()) * placed(Vec3(0, 0, speed * t)); });
    ASSERT_EQ(found.teleports.size(), 1u);
    EXPECT_EQ(found.teleports[0].frame, 1021);
    EXPECT_LT((found.teleports[0].motion.matrix() - jump.matrix()).norm(), 1e-12)
        << "the walk goes on, the jump is only the jump";
    EXPECT_NEAR(found.distances[0], 3, 1e-12);
    EXPECT_TRUE(found.part_jumps.empty());
    EXPECT_EQ(found.teleports[0].velocity_change, Vec3::Zero());
  }
}

TEST(TeleportScan, finds_a_turn_on_the_spot_and_a_jump_with_a_turn) {
  for (const auto& jump : {placed(Vec3::Zero(), std::numbers::pi / 2), placed(Vec3(1, 0, -2), 3.0)}) {
    const auto found = scan([&](double t) { return t > 0.79 ? jump : Eigen::Isometry3d::Identity(); });
    ASSERT_EQ(found.teleports.size(), 1u);
    EXPECT_LT((found.teleports[0].motion.matrix() - jump.matrix()).norm(), 1e-12);
  }
}

TEST(TeleportScan, finds_a_jump_that_the_frame_rate_of_the_source_spreads_over_two_frames) {
  for (const double begin : {0.75, 0.765, 0.78, 0.79}) {  // linear over 1/30 s
    const auto found = scan([&](double t) { return placed(Vec3(3 * std::clamp((t - begin) * 30, 0.0, 1.0), 0, 0)); });
    Vec3 sum = Vec3::Zero();
    for (const Teleport& t : found.teleports) sum += t.motion.translation();
    EXPECT_GE(found.teleports.size(), 1u) << begin;
    EXPECT_LT((sum - Vec3(3, 0, 0)).norm(), 1e-9) << begin;
  }
}

TEST(TeleportScan, finds_a_flicker_in_both_directions) {
  const auto found = scan([](double t) { return placed(Vec3(std::abs(t - 0.8) < 1e-6 ? 2.0 : 0.0, 0, 0)); });
  ASSERT_EQ(found.teleports.size(), 2u);
  EXPECT_LT((found.teleports[0].motion.translation() - Vec3(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((found.teleports[1].motion.translation() + Vec3(2, 0, 0)).norm(), 1e-12);
}

TEST(TeleportScan, gives_the_velocity_of_a_cut_into_another_motion) {
  const auto found =
      scan([](double t) { return t > 0.79 ? placed(Vec3(5 + 6 * (t - 0.8), 0, 0)) : Eigen::Isometry3d::Identity(); });
  ASSERT_EQ(found.teleports.size(), 1u);
  EXPECT_LT((found.teleports[0].velocity_change - Vec3(6, 0, 0)).norm(), 1e-9);
}

TEST(TeleportScan, says_which_part_jumps_when_the_body_does_not) {
  const auto found = scan(still(), [](double t) { return placed(Vec3(0, 0, t > 0.79 ? 1.5 : 0)); });
  EXPECT_TRUE(found.teleports.empty());
  ASSERT_EQ(found.part_jumps.size(), 1u);
  EXPECT_EQ(found.part_jumps[0].part, "leg");
  EXPECT_EQ(found.part_jumps[0].frame, 1021);
  const auto notes = teleport_notes(found, "dancer");
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("frames 1020 and 1021"), std::string::npos) << notes[0];
}

TEST(TeleportScan, does_not_take_quick_motion_for_a_teleport) {
  for (const double fps : {12.0, 24.0, 25.0, 30.0, 60.0, 120.0}) {
    // A foot that swings through 1.2 m and is 16 m/s fast in the middle, forth and back.
    const auto kick = [](double t) {
      return placed(Vec3(0, 0, 0.6 * std::sin(16 / 0.6 * std::clamp(t - 0.5, 0.0, 0.4712))));
    };
    expect_nothing(scan(still(), kick, fps), "kick");
    // 12 m/s from a standing start of one frame, and dead stop against a wall.
    expect_nothing(scan([](double t) { return placed(Vec3(12 * std::clamp(t - 0.3, 0.0, 0.5), 0, 0)); }, still(), fps),
                   "run into a wall");
    expect_nothing(
        scan([](double t) { return placed(Vec3(0, -0.5 * 9.81 * std::pow(std::clamp(t - 0.2, 0.0, 1.0), 2), 0)); },
             still(), fps),
        "fall of 5 m");
    expect_nothing(scan([](double t) { return placed(Vec3(50 * t, 0, 0)); }, still(), fps), "in a car");
    expect_nothing(scan([](double t) { return placed(Vec3::Zero(), 36 * t); }, still(), fps), "pirouette");
    expect_nothing(scan([](double t) { return placed(Vec3(t > 0.79 ? 0.05 : 0, 0, 0)); }, still(), fps), "cut of 5 cm");
  }
}

TEST(TeleportScan, obeys_who_knows_better) {
  const auto body = person([](double t) { return placed(Vec3(t > 0.79 ? 3 : 0, 0, 0)); }, still());
  TeleportScanSettings settings;
  settings.first_frame = 1001, settings.last_frame = 1050, settings.fps = 25;
  settings.detect = false;
  EXPECT_TRUE(scan_teleports(body, settings).teleports.empty());
  settings.frames = {900, 1010, 2000};  // the frames that are not baked do not matter
  const auto named = scan_teleports(body, settings);
  ASSERT_EQ(named.teleports.size(), 1u);
  EXPECT_EQ(named.teleports[0].frame, 1010);
  EXPECT_LT((named.teleports[0].motion.matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-12);
}

TEST(TeleportScan, finds_none_in_recorded_and_drawn_motion_slow) {
  const auto root = test::assets_root();
  int looked_at = 0;
  const auto look = [&](const std::filesystem::path& file, const std::filesystem::path& animation,
                        const std::string& name, double start, double duration, double height) {
    ImportRequest request;
    request.file = file, request.animation = animation, request.clip = name, request.height = height,
    request.clip_start = start, request.duration = duration;
    request.body = "capsules", request.preroll = 1, request.shot_fps = 25;
    auto primary = import_primary(request);
    ASSERT_TRUE(primary) << file << " " << name << ": " << primary.error().text();
    TeleportScanSettings settings;
    settings.first_frame = 1, settings.last_frame = 1 + static_cast<int>(duration * 25), settings.fps = 25,
    settings.preroll_frames = 25;
    expect_nothing(scan_teleports(*primary->trajectory, settings), file.filename().string() + " " + name);
    ++looked_at;
  };
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"characters", "mocap"})
    if (std::filesystem::exists(root / folder))
      for (const auto& entry : std::filesystem::recursive_directory_iterator(root / folder)) {
        const auto extension = entry.path().extension();
        if (extension == ".glb" || extension == ".gltf" || extension == ".bvh" || extension == ".fbx")
          files.push_back(entry.path());
      }
  std::sort(files.begin(), files.end());
  std::map<std::filesystem::path, std::filesystem::path>
      wearer;  // folder -> its character, for files that hold motion only
  for (const auto& file : files)
    if (const auto info = inspect_character(file); info && info->triangle_count > 0)
      wearer.try_emplace(file.parent_path(), file);
  for (const auto& file : files) {
    const auto info = inspect_character(file);
    if (!info) continue;
    // Recordings begin with a calibration pose that nobody walks out of.
    const bool recorded =
        file.string().find("cmu") != std::string::npos || file.string().find("fair1") != std::string::npos;
    const double start = recorded ? 0.2 : 0, height = info->bind_bounds.size().y() > 4 ? 1.7 : 0;
    const bool bvh = file.extension() == ".bvh", alone = bvh || info->triangle_count > 0;
    if (!alone && !wearer.contains(file.parent_path())) continue;
    for (const ClipInfo& clip : info->clips) {
      const double duration = std::floor(25 * std::min(clip.duration, 60.0)) / 25 - 0.04;
      if (duration < 0.1) continue;
      if (alone)
        look(file, {}, clip.name, start, duration - start, height);
      else
        look(wearer[file.parent_path()], file, clip.name, start, duration - start, 0);
    }
  }
  RecordProperty("clips", looked_at);
  const auto calibrated = root / "characters/mh_adult_cmu_dressed/adult_cmu01.glb";
  if (std::filesystem::exists(calibrated)) {
    ImportRequest request;
    request.file = calibrated, request.clip = "01_03_climb_hang_swing", request.duration = 1;
    auto primary = import_primary(request);
    ASSERT_TRUE(primary);
    const auto found = scan_teleports(
        *primary->trajectory,
        {.first_frame = 1, .last_frame = 25, .preroll_frames = 25, .fps = 25, .detect = true, .frames = {}});
    ASSERT_EQ(found.teleports.size(), 1u) << "out of its calibration pose it turns by 108 degrees in a frame";
    EXPECT_EQ(found.teleports[0].frame, 2);
  }
  if (looked_at == 0) GTEST_SKIP() << "skipped: " << root << " not present";
}

}  // namespace
}  // namespace ft

// Clips that repeat: each cycle is the one before, moved on; what differs between a clip's end and its start is named.
#include "io/import/motion/cycle.h"

#include <gtest/gtest.h>

#include <numbers>

#include "baker/core/rigid.h"
#include "baker/core/shapes.h"
#include "io/import/character/clips.h"
#include "io/import/character/cut_track.h"
#include "io/import/motion/cycle_curves.h"
#include "io/import/motion/sampled_trajectory.h"

namespace ft {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

Mat4 turned(double degrees, const Vec3& axis, const Vec3& place, double scale = 1) {
  Mat4 out = Mat4::Identity();
  out.topLeftCorner<3, 3>() = scale * Eigen::AngleAxisd(degrees * k_degree, axis).toRotationMatrix();
  out.topRightCorner<3, 1>() = place;
  return out;
}

void push(Track& track, double time, const std::vector<double>& values) {
  track.times.push_back(time);
  track.values.insert(track.values.end(), values.begin(), values.end());
}

std::vector<double> about_z(double degrees) {
  return {0, 0, std::sin(0.5 * degrees * k_degree), std::cos(0.5 * degrees * k_degree)};
}

/// A block on a pelvis below a root below a set that is turned, moved and scaled; centimetres, z up. The root goes
/// along and turns, the pelvis rises and falls. end_height: how much higher it ends than it began [cm].
struct Walker {
  PlacedCharacter placed;
  ImportRequest request;

  explicit Walker(double end_height = 0, bool channel_of_root_turns = true) {
    Character& c = placed.character;
    c.format = "test";
    c.nodes = {{"set", -1, turned(30, Vec3::UnitZ(), Vec3(100, -40, 0), 2), {}},
               {"root", 0, turned(15, Vec3::UnitZ(), Vec3(5, 0, 0)), {}},
               {"pelvis", 1, turned(0, Vec3::UnitZ(), Vec3(0, 0, 45)), {}}};
    const TriangleSurface box = box_surface(Vec3(20, 10, 60));
    CharacterMesh mesh;
    mesh.name = "block", mesh.node = 2;
    mesh.positions.assign(box.positions.begin(), box.positions.end());
    mesh.triangles.assign(box.triangles.begin(), box.triangles.end());
    c.meshes = {mesh};
    Channel root, pelvis;
    root.node = 1, pelvis.node = 2;
    root.translation.width = 3, root.rotation.width = 4;
    push(root.translation, 2, {5, 0, 0});
    push(root.translation, 2.4, {25, 10, 0});
    push(root.translation, 3, {60, 12, 0});
    if (channel_of_root_turns) {
      push(root.rotation, 2, about_z(15));
      push(root.rotation, 2.5, about_z(30));
      push(root.rotation, 3, about_z(55));
    } else {
      root.rotation.width = 0;
    }
    pelvis.translation.width = 3, pelvis.translation.interpolation = KeyInterpolation::k_cubic;
    push(pelvis.translation, 2.1, {9, 9, 9, 0, 0, 45, 0, 0, 40});
    push(pelvis.translation, 2.5, {0, 0, 10, 0, 0, 52, 0, 0, 10});
    push(pelvis.translation, 3, {0, 0, -30, 0, 0, 45 + end_height, 7, 7, 7});
    pelvis.rotation.width = 4, pelvis.rotation.interpolation = KeyInterpolation::k_step;
    push(pelvis.rotation, 2, about_z(0));
    push(pelvis.rotation, 2.25, about_z(20));
    push(pelvis.rotation, 2.75, about_z(0));
    Clip clip{.name = "walk", .channels = {root, pelvis}};
    clip.find_range();
    c.clips = {clip};
    placed.clip = 0, placed.pelvis = 2;
    placed.placement = turned(-90, Vec3::UnitX(), Vec3::Zero(), 0.01);
    placed.skin = weld(c, {0}, placed.info.notes);
    placed.skin.surface.part_of_vertex.assign(placed.skin.base.size(), 0);
    placed.skin.surface.parts.resize(1);
    placed.bind = find_bind_pose(c);
    request.shot_fps = 24, request.first_frame = 1, request.loop = true, request.preroll = 0.5;
    request.duration = 5;
  }

  std::unique_ptr<Trajectory> trajectory(bool repeated) {
    PlacedCharacter own = placed;
    own.playback.start = 2 + request.clip_start, own.playback.speed = request.speed,
    own.playback.preroll = request.preroll;
    if (repeated) {
      const Status done = repeat_clip(own, {0}, 1.2, request);
      EXPECT_TRUE(done.ok());
      notes = own.info.notes, seam_frames = own.info.seam_frames;
      EXPECT_TRUE(check_character(own.character).ok());
    }
    const auto kept = std::make_shared<const Character>(own.character);
    return std::make_unique<CharacterTrajectory>(kept, &kept->clips[0], own.skin, own.bind, own.pelvis, own.placement,
                                                 own.playback);
  }
  std::vector<std::string> notes;
  std::vector<int> seam_frames;
};

std::vector<Vec3> sample(const Trajectory& trajectory, double time) {
  std::vector<Vec3> out(at(trajectory.surface().vertex_count()));
  trajectory.sample(time, out);
  return out;
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = 0;
  for (std::size_t v = 0; v < a.size(); ++v) out = std::max(out, (a[v] - b[v]).norm());
  return out;
}

/// 32-bit times make a cycle end up to this early [s]; nothing moves faster than 2 m/s.
constexpr double k_early = 2e-6, k_close = 1e-9;

TEST(Cycle, Every_cycle_is_the_first_one_carried_on) {
  for (const bool turns : {true, false}) {
    Walker walker(0, turns);
    walker.request.duration = 1;
    const auto once = walker.trajectory(false);
    const auto step = rigid_fit(sample(*once, 0), sample(*once, 1));
    EXPECT_GT(step.translation().norm(), 0.5);
    EXPECT_NEAR(Eigen::AngleAxisd(step.linear()).angle(), turns ? 40 * k_degree : 0, 1e-9);
    walker.request.duration = 5;
    const auto repeated = walker.trajectory(true);
    Eigen::Isometry3d carried = Eigen::Isometry3d::Identity();
    for (int n = 0; n < 5; ++n, carried = step * carried)
      for (const double phase : {0.0, 0.05, 0.1, 0.2, 0.25, 0.4, 0.7, 0.75, 0.9, 1 - 2 * k_early}) {
        std::vector<Vec3> expected = sample(*once, phase);
        for (Vec3& p : expected) p = carried * p;
        EXPECT_LT(farthest(sample(*repeated, n + phase), expected), k_close) << n << " " << phase;
      }
    ASSERT_EQ(walker.notes.size(), 1u);
    EXPECT_NE(walker.notes[0].find("up to 0 mm apart"), std::string::npos) << walker.notes[0];
    EXPECT_NE(walker.notes[0].find(turns ? "turns by 40 degrees" : "turns by 0 degrees"), std::string::npos)
        << walker.notes[0];
    EXPECT_EQ(walker.notes[0].find("jumps"), std::string::npos) << walker.notes[0];
  }
}

TEST(Cycle, A_shot_that_starts_in_a_later_cycle_is_where_the_whole_shot_has_it) {
  Walker walker;
  walker.request.duration = 8;
  const auto whole = walker.trajectory(true);
  walker.request.clip_start = 6.3, walker.request.duration = 0.5;
  const auto part = walker.trajectory(true);
  for (const double time : {0.0, 0.2, 0.5}) EXPECT_LT(farthest(sample(*part, time), sample(*whole, 6.3 + time)), 1e-9);
  walker.request.clip_start = 0, walker.request.speed = 2, walker.request.duration = 4;
  const auto fast = walker.trajectory(true);
  for (const double time : {0.3, 2.4, 3.9}) EXPECT_LT(farthest(sample(*fast, time), sample(*whole, 2 * time)), 1e-9);
  EXPECT_EQ(walker.seam_frames, (std::vector<int>{13, 25, 37, 49, 61, 73, 85, 97}));
}

TEST(Cycle, The_speed_at_a_seam_is_that_of_its_neighbours) {
  Walker walker;
  const auto repeated = walker.trajectory(true);
  const double frame = 1.0 / 24;
  for (int f = 1; f < 119; ++f) {
    const auto before = sample(*repeated, (f - 1) * frame), now = sample(*repeated, f * frame),
               after = sample(*repeated, (f + 1) * frame);
    double fastest = 0;
    for (std::size_t v = 0; v < now.size(); ++v) fastest = std::max(fastest, (after[v] - before[v]).norm() * 12);
    EXPECT_LT(fastest, 4) << f;  // a carried root alone goes 1.2 m a cycle, the block's corners turn by 20 degrees
  }
}

TEST(Cycle, A_seam_is_measured_and_a_large_one_names_its_frames) {
  Walker walker(3);  // 3 cm below a set of twice the size
  walker.trajectory(true);
  ASSERT_EQ(walker.notes.size(), 1u);
  EXPECT_NE(walker.notes[0].find("up to 60 mm apart"), std::string::npos) << walker.notes[0];
  EXPECT_NE(walker.notes[0].find("jumps into frames 25, 49, 73, 97, 121;"), std::string::npos) << walker.notes[0];
  walker = Walker(0.5);  // 10 mm of 1.2 m
  walker.trajectory(true);
  EXPECT_NE(walker.notes[0].find("up to 10 mm apart"), std::string::npos) << walker.notes[0];
  EXPECT_EQ(walker.notes[0].find("jumps"), std::string::npos) << walker.notes[0];
}

TEST(Cycle, A_short_shot_keeps_the_keys_of_its_file) {
  Walker walker;
  walker.request.duration = 0.9;
  PlacedCharacter placed = walker.placed;
  ASSERT_TRUE(repeat_clip(placed, {0}, 1.2, walker.request).ok());
  EXPECT_FALSE(placed.repeated);
  EXPECT_EQ(placed.character.clips[0].channels[0].translation.times,
            walker.placed.character.clips[0].channels[0].translation.times);
  EXPECT_NE(placed.info.notes[0].find("the shot ends before it"), std::string::npos);
}

TEST(Cycle, A_shot_longer_than_its_clip_is_offered_it) {
  const Walker walker;
  ImportRequest request = walker.request;
  request.loop = false;
  const Status refused = check_clip_range(walker.placed.character.clips[0], request, "walk.glb");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("loop = true"), std::string::npos) << refused.error().text();
  EXPECT_TRUE(check_clip_range(walker.placed.character.clips[0], walker.request, "walk.glb").ok());
}

TEST(Cycle, Too_many_keys_are_refused_before_they_are_made) {
  Walker walker;
  walker.request.duration = 1e8;
  PlacedCharacter placed = walker.placed;
  const Status refused = repeat_clip(placed, {0}, 1.2, walker.request);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().text().find("million keys"), std::string::npos) << refused.error().text();
  const CycleSpan span = cycles_of_shot({.period = 1}, walker.request);
  EXPECT_EQ(span.seam_count, 100'000'000);
  EXPECT_EQ(span.seam_frames.size(), k_most_seams);
}

TEST(Cycle, Samples_of_a_geometry_cache_repeat_likewise) {
  GeometryCache cache;
  const TriangleSurface box = box_surface(Vec3(0.4, 1, 0.2));
  cache.mesh = make_triangle_mesh("box", box.positions, box.triangles);
  cache.vertex_count = static_cast<int>(box.positions.size());
  const Eigen::Isometry3d step = Eigen::Translation3d(0.3, 0, 0.1) * Eigen::AngleAxisd(25 * k_degree, Vec3::UnitY());
  for (int s = 0; s <= 8; ++s) {
    cache.times.push_back(s / 8.0);
    for (const Vec3& p : box.positions) {
      Vec3 x = p + Vec3(0, 0.05 * std::sin(2 * std::numbers::pi * (s % 8) / 8.0), 0);
      if (s == 8) x = step * x;
      cache.positions.push_back(x.cast<float>());
    }
  }
  Playback playback{.start = 0, .speed = 1, .preroll = 0, .bind = {}, .loop = false};
  const SampledTrajectory once(cache, Mat3::Identity(), 1, playback);
  playback.loop = true;
  const SampledTrajectory repeated(cache, Mat3::Identity(), 1, playback);
  EXPECT_LT(repeated.cycle().seam, 1e-6);
  EXPECT_TRUE(repeated.cycle().step.isApprox(step, 1e-6));
  for (const double phase : {0.0, 0.3, 0.99}) {
    std::vector<Vec3> expected = sample(once, phase);
    for (Vec3& p : expected) p = step * (step * p);
    EXPECT_LT(farthest(sample(repeated, 2 + phase), expected), 1e-6);
  }
}

TEST(Cycle_curves, Repeat_key_by_key_and_hold_where_the_curve_holds) {
  Curve curve;
  curve.times = {2.25, 2.5, 3}, curve.values = {1, 4, -2};
  curve.interpolation = {CurveInterpolation::k_cubic, CurveInterpolation::k_linear, CurveInterpolation::k_cubic};
  curve.handles = {{0, 0, 0.1, 1}, {0.05, 2, 0.1, 0.5}, {0.1, 0, 0, 0}};
  const Curve repeated = repeated_curve(curve, {2, 1, 0, 3});
  for (int n = 0; n < 4; ++n)
    for (const double phase : {0.0, 0.1, 0.25, 0.3, 0.5, 0.8, 0.999})
      EXPECT_NEAR(repeated.at(2 + n + phase), curve.at(2 + phase), 1e-9) << n << " " << phase;
  EXPECT_EQ(repeated.at(6), -2);  // the end of the last cycle
  // One that goes on beyond its keys.
  curve.after.rule = CurveInfinity::k_repeat, curve.times = {2, 2.2, 2.5};
  const Curve sampled = repeated_curve(curve, {2, 1, 0, 1});
  EXPECT_NEAR(sampled.at(3.7), curve.at(2.7), 1e-2);
}

TEST(Cycle_curves, Jumps_stay_jumps_where_a_curve_is_not_repeated_by_its_keys) {
  Curve steps;  // goes on beyond both ends of the cycle, which is from 2 to 3
  steps.times = {1.7, 2.25, 2.5, 2.8, 3.4}, steps.values = {1, 4, -2, 6, 0};
  steps.interpolation = {CurveInterpolation::k_constant, CurveInterpolation::k_constant_next,
                         CurveInterpolation::k_constant, CurveInterpolation::k_linear, CurveInterpolation::k_constant};
  Curve saw;  // begins anew at 2.3, 2.6 and 2.9
  saw.times = {2, 2.3}, saw.values = {0, 1}, saw.after.rule = CurveInfinity::k_repeat;
  for (const Curve* curve : {&steps, &saw}) {
    const Curve repeated = repeated_curve(*curve, {2, 1, 0, 2});
    for (int n = 0; n < 3; ++n)
      for (const double place : {0.0, 0.25, 0.3, 0.5, 0.6, 0.8, 0.9})
        for (const double off : {1e-7, 0.001, -0.001, -1e-7}) {
          if (place + off < 0) continue;
          EXPECT_NEAR(repeated.at(2 + n + place + off), curve->at(2 + place + off), 1e-9) << n << " " << place << off;
        }
    for (const double place : {0.25, 0.5, 0.8}) EXPECT_NEAR(repeated.at(2 + place), curve->at(2 + place), 1e-9);
  }
}

TEST(Cycle, A_root_with_a_stack_of_transforms_is_carried_alike) {
  Walker walker;
  Clip& clip = walker.placed.character.clips[0];
  Walker same = walker;
  const auto expected = same.trajectory(true);
  // The root's channel as curves, straight lines as its keys are: of angles, which the channel's slerps are as well.
  TransformStack stack;
  stack.node = 1;
  ElementaryTransform move, turn;
  move.kind = TransformKind::k_translate, turn.kind = TransformKind::k_rotate;
  const auto curve = [&](const std::vector<double>& times, const std::vector<double>& values) {
    Curve out;
    out.times = times, out.values = values;
    clip.curves.curves.push_back(out);
    return static_cast<std::int32_t>(clip.curves.curves.size()) - 1;
  };
  clip.curves.layers.emplace_back();
  LayeredNumbers places, angles;
  places.curves = {curve({2, 2.4, 3}, {5, 25, 60}), curve({2, 2.4, 3}, {0, 10, 12}), -1};
  angles.curves = {-1, -1, curve({2, 2.5, 3}, {15, 30, 55})};
  move.numbers.layers = {places}, turn.numbers.layers = {angles};
  stack.elements = {move, turn};
  clip.stacks = {stack};
  clip.channels.erase(clip.channels.begin());
  const auto stacked = walker.trajectory(true);
  for (double time = 0; time < 4.9; time += 0.0625)
    EXPECT_LT(farthest(sample(*stacked, time), sample(*expected, time)), 1e-7) << time;
}

TEST(Cut_track, Keeps_the_curve_within_and_nothing_without) {
  Track track;
  track.width = 1, track.interpolation = KeyInterpolation::k_cubic;
  push(track, 0, {0, 1, 2});
  push(track, 1, {-1, 3, 4});
  push(track, 3, {0.5, -2, 1});
  const Track cut = cut_track(track, 0.25, 2, false);
  EXPECT_EQ(cut.times, (std::vector<double>{0.25, 1, 2}));
  for (const double time : {0.25, 0.4, 0.9, 1.0, 1.3, 2.0}) {
    double a = 0, b = 0;
    sample_track(track, time, false, std::span(&a, 1));
    sample_track(cut, time, false, std::span(&b, 1));
    EXPECT_NEAR(a, b, 1e-12) << time;
  }
  EXPECT_EQ(cut_track(track, 0, 3, false).values, track.values);
  EXPECT_EQ(cut_track(track, 4, 5, false).times, std::vector<double>{4});
}

}  // namespace
}  // namespace ft

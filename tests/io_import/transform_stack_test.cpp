// Stacks of transforms: orders of rotation, layers, inherited scales and shapes in between, against closed forms.
#include "io/import/character/transform_stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "baker/core/random.h"
#include "io/import/character/clips.h"
#include "io/import/character/motion_change.h"
#include "io/import/character/plain_clip.h"
#include "io/import/character/pose.h"

namespace ft {
namespace {

constexpr double k_degree = std::numbers::pi / 180;

Mat3 about(int axis, double degrees) {
  return Eigen::AngleAxisd(degrees * k_degree, Vec3::Unit(axis)).toRotationMatrix();
}

TEST(RotationOrder, Is_that_in_which_the_axes_turn) {
  const Vec3 a(20, -35, 80);
  const Mat3 x = about(0, 20), y = about(1, -35), z = about(2, 80);
  const auto matrix = [&](RotationOrder order) { return rotation_of(a, order).toRotationMatrix(); };
  EXPECT_TRUE(matrix(RotationOrder::k_xyz).isApprox(z * y * x, 1e-14));
  EXPECT_TRUE(matrix(RotationOrder::k_xzy).isApprox(y * z * x, 1e-14));
  EXPECT_TRUE(matrix(RotationOrder::k_yzx).isApprox(x * z * y, 1e-14));
  EXPECT_TRUE(matrix(RotationOrder::k_yxz).isApprox(z * x * y, 1e-14));
  EXPECT_TRUE(matrix(RotationOrder::k_zxy).isApprox(y * x * z, 1e-14));
  EXPECT_TRUE(matrix(RotationOrder::k_zyx).isApprox(x * y * z, 1e-14));
}

TEST(RotationOrder, Angles_give_the_rotation_back_and_so_they_do_at_the_poles) {
  std::uint64_t draw = 0;
  const auto uniform = [&] { return random_uniform({3, 0, 0, 0}, draw++); };
  for (int order = 0; order < 6; ++order)
    for (int round = 0; round < 200; ++round) {
      Vec3 a;
      for (int k = 0; k < 3; ++k) a[k] = -180 + 360 * uniform();
      if (round % 4 == 0) a[round / 4 % 3] = 90;
      const auto o = static_cast<RotationOrder>(order);
      const Quat q = rotation_of(a, o);
      EXPECT_LT(q.angularDistance(rotation_of(angles_of(q, o), o)), 1e-6);
    }
}

/// One layer over a base: both constant.
Vec3 layered(AnimationLayer layer, TransformKind kind, const Vec3& base, const Vec3& over) {
  ClipCurves set;
  set.layers = {AnimationLayer{}, layer};
  AnimatedNumbers numbers;
  numbers.rest = Vec3(9, 9, 9);
  numbers.layers = {{0, base, {-1, -1, -1}}, {1, over, {-1, -1, -1}}};
  return numbers_at(numbers, kind, RotationOrder::k_xyz, set, 0);
}

TEST(Layers, Add_replace_and_pass_through) {
  const Vec3 a(1, 2, 3), b(4, -5, 6);
  const auto layer = [](LayerMode mode, double weight) {
    AnimationLayer out;
    out.mode = mode, out.weight = weight;
    return out;
  };
  using enum TransformKind;
  EXPECT_TRUE(layered(layer(LayerMode::k_additive, 0.5), k_translate, a, b).isApprox(a + 0.5 * b));
  EXPECT_TRUE(layered(layer(LayerMode::k_override, 0.5), k_translate, a, b).isApprox(b));
  EXPECT_TRUE(layered(layer(LayerMode::k_blend, 0.25), k_translate, a, b).isApprox(0.75 * a + 0.25 * b));
  EXPECT_TRUE(layered(layer(LayerMode::k_additive, 1), k_rotate, a, b).isApprox(a + b));
  EXPECT_TRUE(layered(layer(LayerMode::k_additive, 1), k_scale, a, b).isApprox(a + b));
}

TEST(Layers, Rotations_may_be_put_together_and_scales_multiplied) {
  AnimationLayer layer;
  layer.mode = LayerMode::k_additive, layer.composes_rotations = layer.multiplies_scales = true;
  const Vec3 a(30, 40, 50), b(-20, 70, 10), s(2, 3, -4), t(0.25, 4, 2);
  const auto order = RotationOrder::k_xyz;
  const Quat both = rotation_of(a, order) * rotation_of(b, order);
  EXPECT_LT(both.angularDistance(rotation_of(layered(layer, TransformKind::k_rotate, a, b), order)), 1e-7);
  EXPECT_TRUE(layered(layer, TransformKind::k_scale, s, t).isApprox(s.cwiseProduct(t)));
  layer.weight = 0.5;
  EXPECT_TRUE(layered(layer, TransformKind::k_scale, s, t).isApprox(Vec3(1, 6, -4 * std::sqrt(2)), 1e-14));
  layer.mode = LayerMode::k_blend;
  const Quat half = rotation_of(a, order).slerp(0.5, rotation_of(b, order));
  EXPECT_LT(half.angularDistance(rotation_of(layered(layer, TransformKind::k_rotate, a, b), order)), 1e-7);
}

TEST(Layers, A_weight_may_move) {
  ClipCurves set;
  set.curves.resize(1);
  set.curves[0].times = {0, 1}, set.curves[0].values = {0, 100};
  AnimationLayer layer;
  layer.mode = LayerMode::k_additive, layer.weight_curve = 0;
  set.layers = {layer};
  AnimatedNumbers numbers;
  numbers.layers = {{0, Vec3(8, 0, 0), {-1, -1, -1}}};
  EXPECT_DOUBLE_EQ(numbers_at(numbers, TransformKind::k_translate, RotationOrder::k_xyz, set, 0.25).x(), 2);
}

TEST(Shapes, In_between_share_the_weight) {
  const std::vector<ShapeChannel::Shape> shapes{{0, 50}, {1, 100}};
  std::vector<double> w(2);
  const auto at = [&](double percent) {
    shape_weights(shapes, percent, w);
    return std::pair(w[0], w[1]);
  };
  EXPECT_EQ(at(0), std::pair(0.0, 0.0));
  EXPECT_EQ(at(25), std::pair(0.5, 0.0));
  EXPECT_EQ(at(50), std::pair(1.0, 0.0));
  EXPECT_EQ(at(75), std::pair(0.5, 0.5));
  EXPECT_EQ(at(100), std::pair(0.0, 1.0));
  EXPECT_EQ(at(150), std::pair(-1.0, 2.0));
}

/// hips -> spine -> head, each 10 above the one below it, turned by 30 degrees about z; the scale of the hips moves
/// from 1 to (2, 1, 3) in a second.
Character figure(ScaleInheritance inheritance) {
  Character c;
  Clip clip;
  clip.name = "scaled";
  clip.curves.layers.assign(1, {});
  clip.curves.curves.resize(2);
  clip.curves.curves[0].times = clip.curves.curves[1].times = {0, 1};
  clip.curves.curves[0].values = {1, 2}, clip.curves.curves[1].values = {1, 3};
  for (int n = 0; n < 3; ++n) {
    c.nodes.push_back({"joint " + std::to_string(n), n - 1, Mat4::Identity(), {}});
    c.nodes.back().local.topLeftCorner<3, 3>() = about(2, 30);
    c.nodes.back().local(1, 3) = 10;
    TransformStack stack;
    stack.node = n, stack.inheritance = n == 0 ? ScaleInheritance::k_product : inheritance;
    stack.elements.resize(3);
    stack.elements[0].numbers.rest = Vec3(0, 10, 0);
    stack.elements[1].kind = TransformKind::k_rotate, stack.elements[1].numbers.rest = Vec3(0, 0, 30);
    stack.elements[2].kind = TransformKind::k_scale, stack.elements[2].numbers.rest = Vec3::Ones();
    if (n == 0) stack.elements[2].numbers.layers = {{0, Vec3::Ones(), {0, -1, 1}}};
    clip.stacks.push_back(std::move(stack));
  }
  clip.find_range();
  c.clips.push_back(std::move(clip));
  return c;
}

std::vector<Mat4> globals_at(const Character& c, double time) {
  const ClipPose pose(c, &c.clips[0]);
  std::vector<Mat4> locals(c.nodes.size()), globals(c.nodes.size());
  std::vector<double> morphs(pose.rest_morphs().size());
  pose.sample(time, locals, morphs);
  globals_from_locals(c.nodes, locals, globals);
  return globals;
}

TEST(InheritedScale, Is_that_of_the_three_rules) {
  const Vec3 scale(2, 1, 3);
  const Mat3 turn = about(2, 30);
  const Mat3 hips = turn * scale.asDiagonal();
  const Vec3 up(0, 10, 0);
  ASSERT_TRUE(check_character(figure(ScaleInheritance::k_product)));
  const auto product = globals_at(figure(ScaleInheritance::k_product), 1);
  EXPECT_TRUE((product[1].topLeftCorner<3, 3>().isApprox(hips * turn, 1e-13)));
  const auto free = globals_at(figure(ScaleInheritance::k_compensated), 1);
  EXPECT_TRUE((free[1].topLeftCorner<3, 3>().isApprox(turn * turn, 1e-13)));
  EXPECT_TRUE((free[2].topLeftCorner<3, 3>().isApprox(turn * turn * turn, 1e-13)));
  const Vec3 spine = up + hips * up;
  EXPECT_TRUE((free[1].topRightCorner<3, 1>().isApprox(spine, 1e-13)));  // the place is scaled all the same
  EXPECT_TRUE((free[2].topRightCorner<3, 1>().isApprox(spine + turn * turn * up, 1e-13)));
  const auto along = globals_at(figure(ScaleInheritance::k_componentwise), 1);
  EXPECT_TRUE((along[1].topLeftCorner<3, 3>().isApprox(turn * turn * scale.asDiagonal(), 1e-13)));
  EXPECT_TRUE((along[2].topLeftCorner<3, 3>().isApprox(turn * turn * turn * scale.asDiagonal(), 1e-13)));
}

TEST(InheritedScale, Of_nothing_leaves_a_node_that_compensates_its_own) {
  Character c = figure(ScaleInheritance::k_compensated);
  c.clips[0].curves.curves[0].values[1] = 0;
  const Mat3 spine = globals_at(c, 1)[1].topLeftCorner<3, 3>();
  EXPECT_TRUE(spine.isApprox(about(2, 60), 1e-7));
}

TEST(Stacks, Survive_the_way_through_bytes_and_faults_in_them_are_found) {
  const Character c = figure(ScaleInheritance::k_compensated);
  const auto loaded = load_character_bytes(save_character(c));
  ASSERT_TRUE(loaded) << loaded.error().text();
  for (const double t : {0.0, 0.3, 1.0})
    for (int n = 0; n < 3; ++n)
      EXPECT_EQ(globals_at(c, t)[static_cast<std::size_t>(n)], globals_at(*loaded, t)[static_cast<std::size_t>(n)]);
  const auto refused = [&](auto&& change) {
    Character bad = c;
    change(bad.clips[0]);
    return !check_character(bad);
  };
  EXPECT_TRUE(refused([](Clip& k) { k.stacks[1].node = 7; }));
  EXPECT_TRUE(refused([](Clip& k) { k.stacks[1].node = 0; }));
  EXPECT_TRUE(refused([](Clip& k) { k.stacks[0].elements[2].numbers.layers[0].curves[0] = 2; }));
  EXPECT_TRUE(refused([](Clip& k) { k.stacks[0].elements[2].numbers.layers[0].layer = 1; }));
  EXPECT_TRUE(refused([](Clip& k) { k.curves.curves[0].times[1] = -1; }));
  EXPECT_TRUE(refused([](Clip& k) { k.curves.curves[0].values.pop_back(); }));
  EXPECT_TRUE(refused([](Clip& k) { k.curves.curves[0].handles.resize(1); }));
  EXPECT_TRUE(refused([](Clip& k) { k.curves.layers[0].weight_curve = 2; }));
  EXPECT_TRUE(refused([](Clip& k) { k.shapes.push_back({0, {{0, 100}}, {}}); }));
  EXPECT_FALSE(refused([](Clip&) {}));
}

TEST(Stacks, Move_to_another_file_with_its_unit_and_names) {
  Character source = figure(ScaleInheritance::k_product), target = source;
  source.file_unit = 1, target.file_unit = 0.01;
  std::reverse(target.nodes.begin(), target.nodes.end());
  for (CharacterNode& node : target.nodes) node.parent = -1;
  std::vector<std::string> notes;
  auto clips = retarget_clips(source, target, "walk.fbx", notes);
  ASSERT_TRUE(clips);
  target.clips = std::move(*clips);
  ASSERT_TRUE(check_character(target));
  EXPECT_NEAR(globals_at(target, 0)[2](1, 3), 1000, 1e-9);
  EXPECT_NEAR(globals_at(target, 1)[2](0, 0), 2 * std::cos(30 * k_degree), 1e-12);
  EXPECT_NEAR(globals_at(target, 1)[0](0, 0), std::cos(30 * k_degree), 1e-12);
}

TEST(Stacks, A_changed_part_goes_over_the_stack) {
  Character c = figure(ScaleInheritance::k_product);
  const ChangedChannel change{1, ChannelPath::k_rotation, {KeyInterpolation::k_linear, 4, {0}, {0, 0, 0, 1}}};
  ASSERT_TRUE(apply_changes(c, 0, {&change, 1}));
  const auto globals = globals_at(c, 1);
  EXPECT_TRUE((globals[1].topLeftCorner<3, 3>().isApprox(globals[0].topLeftCorner<3, 3>(), 1e-12)));
  EXPECT_TRUE(varies(c.clips[0], 0));
  EXPECT_FALSE(varies(c.clips[0], 2));
  EXPECT_TRUE(clip_moves(c.clips[0], 1));
  EXPECT_FALSE(clip_moves(c.clips[0], 2));
}

TEST(Stacks, Become_keys_where_a_format_knows_nothing_else) {
  Character c = figure(ScaleInheritance::k_product);
  Clip& clip = c.clips[0];
  clip.stacks[1].elements[1].numbers.layers = {{0, Vec3(0, 0, 30), {2, -1, -1}}};
  Curve curve;
  curve.times = {0, 1}, curve.values = {0, 200};
  curve.interpolation.assign(2, CurveInterpolation::k_cubic);
  curve.handles = {{0, 0, 1.0 / 3, 0}, {1.0 / 3, 0, 0, 0}};
  clip.curves.curves.push_back(curve);
  Character plain = c;
  plain.clips[0] = plain_clip(c, clip, plain.notes);
  EXPECT_TRUE(plain.notes.empty());
  EXPECT_TRUE(plain.clips[0].stacks.empty());
  ASSERT_TRUE(check_character(plain));
  double worst = 0;
  for (double t = 0; t <= 1; t += 0.003)
    worst = std::max(worst, (globals_at(plain, t)[2] - globals_at(c, t)[2]).cwiseAbs().maxCoeff());
  EXPECT_LT(worst, 1e-5);  // of 30
  EXPECT_LT(plain.clips[0].channels[1].rotation.times.size(), 481u);
  EXPECT_EQ(plain.clips[0].channels[2].rotation.times.size(), 2u);
}

TEST(Stacks, Become_keys_at_a_time_of_day_where_floats_are_far_apart) {
  Character c = figure(ScaleInheritance::k_product);
  Clip& clip = c.clips[0];
  constexpr double k_ten_o_clock = 36000;  // s; the next float is 1/256 s on
  clip.stacks[1].elements[1].numbers.layers = {
      {0, Vec3(0, 0, 30), {static_cast<int>(clip.curves.curves.size()), -1, -1}}};
  Curve curve;
  curve.times = {k_ten_o_clock, k_ten_o_clock + 1}, curve.values = {0, 200};
  curve.interpolation.assign(2, CurveInterpolation::k_cubic);
  curve.handles = {{0, 0, 1.0 / 3, 0}, {1.0 / 3, 0, 0, 0}};
  clip.curves.curves.push_back(curve);
  clip.start = k_ten_o_clock, clip.end = k_ten_o_clock + 1;
  const std::vector<double> times = straight_times(c, clip, clip.stacks[1].node);
  EXPECT_LE(times.size(), 257u + 4u);
  EXPECT_TRUE(std::is_sorted(times.begin(), times.end()));
  std::vector<std::string> notes;
  EXPECT_FALSE(plain_clip(c, clip, notes).channels.empty());
}

TEST(Stacks, Shapes_of_one_full_weight_do_not_vanish_there) {
  const std::vector<ShapeChannel::Shape> shapes = {{0, 100}, {1, 100}};
  std::vector<double> out(2);
  for (const double percent : {50.0, 100.0, 120.0}) {
    shape_weights(shapes, percent, out);
    EXPECT_NEAR(out[0] + out[1], percent / 100, 1e-12) << percent;
  }
}

}  // namespace
}  // namespace ft

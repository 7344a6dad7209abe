// The yielding character, from deviation to channels: nothing deviates and nothing changes, the whole is moved as asked
// (also through the written file), planted feet stay while the body sinks, and legs keep their length.
#include "io/import/motion/adjust.h"

#include <cmath>

#include "baker/core/file.h"
#include "io/export/gltf_export.h"
#include "io/import/import.h"
#include "tests/io_export/moved.h"

namespace ft::test {
namespace {

#define FT_PLACE(placed, test_case)                   \
  FT_REQUIRE_FILE((test_case).request.file);          \
  SCOPED_TRACE((test_case).name);                     \
  auto placed = place_character((test_case).request); \
  ASSERT_TRUE(placed) << placed.error().text()

/// Trajectory of a character with changed channels: through the written file where it is a glTF file.
std::unique_ptr<Trajectory> played(const MovedCase& c, const PlacedCharacter& placed,
                                   const std::vector<ChangedChannel>& channels) {
  ScratchFolder scratch;
  if (placed.character.format != "glTF") {
    PlacedCharacter moved = placed;
    EXPECT_TRUE(apply_changes(moved.character, moved.clip, channels));
    return std::move(play(std::move(moved), c.request).value().trajectory);
  }
  auto bytes = export_glb(c.request.file, placed.character, placed.clip, channels);
  EXPECT_TRUE(bytes) << bytes.error().text();
  ImportRequest request = c.request;
  request.file = scratch / "moved.glb";
  EXPECT_TRUE(write_file_durably(request.file, *bytes));
  auto primary = import_primary(request);
  EXPECT_TRUE(primary) << primary.error().text();
  return std::move(primary->trajectory);
}

std::vector<AdjustedLimb> legs_of(const MovedCase& c, const PlacedCharacter& placed) {
  std::vector<AdjustedLimb> out;
  for (const auto& [hip, knee, ankle] : c.legs)
    out.push_back({find_limb(placed.character, hip, knee, ankle).value(), {}, {}});
  if (!c.legs.empty()) return out;
  for (const LimbChain& chain : find_limbs(placed.character))
    if (limbs_by_name(placed.character)[at(chain.end)] == Limb::k_foot) out.push_back({chain, {}, {}});
  return out;
}

TEST(Adjust, Without_a_deviation_no_channel_changes_and_the_file_is_the_same_bytes) {
  for (const MovedCase& c : moved_cases()) {
    FT_PLACE(placed, c);
    MotionAdjustment adjustment = adjustment_of(*placed);
    adjustment.limbs = legs_of(c, *placed);
    for (AdjustedLimb& limb : adjustment.limbs)
      limb.target = [](double, const Vec3& imported) { return LimbTarget{imported, 1}; };
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    EXPECT_TRUE(motion->channels.empty());
    if (c.request.file.extension() != ".glb") continue;
    auto bytes = export_glb(c.request.file, placed->character, placed->clip, motion->channels);
    ASSERT_TRUE(bytes);
    EXPECT_TRUE(*bytes == read_file(c.request.file).value());
  }
}

TEST(Adjust, A_constant_shift_moves_every_vertex_by_it) {
  const Vec3 shift = Vec3(0.6, -0.48, 0.64) * 0.01;
  for (const MovedCase& c : moved_cases()) {
    FT_PLACE(placed, c);
    MotionAdjustment adjustment = adjustment_of(*placed);
    adjustment.deviation = [&](double) { return RootDeviation{.displacement = shift}; };
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    ASSERT_EQ(motion->channels.size(), adjustment.roots.size());
    EXPECT_EQ(motion->channels[0].path, ChannelPath::k_translation);
    const auto before = played(c, *placed, {}), after = played(c, *placed, motion->channels);
    double worst = 0;
    for (double time = 0; time < 0.6; time += 0.037) {  // between keys and frames, too
      const auto a = vertices_at(*before, time), b = vertices_at(*after, time);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t v = 0; v < a.size(); ++v) worst = std::max(worst, (b[v] - a[v] - shift).norm());
    }
    std::printf("%s: %.2e m off\n", c.name, worst);
    EXPECT_LT(worst, 1e-6);
  }
}

TEST(Adjust, A_deviation_that_grows_moves_and_turns_the_whole_body_at_every_frame) {
  for (const MovedCase& c : moved_cases()) {
    FT_PLACE(placed, c);
    MotionAdjustment adjustment = adjustment_of(*placed);
    const double start = placed->playback.start;
    adjustment.deviation = [&](double time) {
      const double s = std::clamp((time - start - 0.25) / 0.3, 0.0, 1.0), w = s * s * (3 - 2 * s);
      if (w == 0) return RootDeviation{};
      return RootDeviation{w * Vec3(0.05, -0.2, 0.1), Quat(Eigen::AngleAxisd(0.5 * w, Vec3(0.6, 0.8, 0))),
                           Vec3(0.1 * time, 0.9, 0)};
    };
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    const auto before = played(c, *placed, {}), after = played(c, *placed, motion->channels);
    double worst = 0, between = 0;
    for (int half = 0; half < 28; ++half) {
      const double time = half / 48.0;
      const RootDeviation d = adjustment.deviation(start + time);
      const auto a = vertices_at(*before, time), b = vertices_at(*after, time);
      double& most = half % 2 == 0 ? worst : between;
      for (std::size_t v = 0; v < a.size(); ++v)
        most = std::max(most, (d.centre + d.displacement + d.rotation * (a[v] - d.centre) - b[v]).norm());
    }
    std::printf("%s: %.2e m off at frames, %.2e between\n", c.name, worst, between);
    // Straight lines between keys h apart are off by a h^2 / 8, and by a h s / 2 at s beside a key.
    const double a_most = 6 * 0.25 / 0.09 + 6 * 0.5 * 3 / 0.09, h = 1.0 / 24;  // three metres from the axis
    EXPECT_LT(worst, 5e-6 + a_most * h * c.key_beside_frame / 2);
    EXPECT_LT(between, a_most * h * h / 8);
    // Keys before it begins are the file's own, where it holds keys of channels and no curves.
    const ChangedChannel& first = motion->channels[0];
    const Clip& clip = placed->character.clips[at(placed->clip)];
    if (find_stack(clip, first.node) != nullptr) continue;
    const Channel* source = find_channel(clip, first.node);
    ASSERT_NE(source, nullptr);
    for (std::size_t k = 0; k < source->translation.times.size(); ++k) {
      if (source->translation.times[k] > start + 0.25) continue;
      const auto same = std::find(first.track.times.begin(), first.track.times.end(), source->translation.times[k]);
      ASSERT_NE(same, first.track.times.end());
      const std::ptrdiff_t key = same - first.track.times.begin();
      EXPECT_TRUE(std::equal(first.track.values.begin() + 3 * key, first.track.values.begin() + 3 * key + 3,
                             source->translation.values.begin() + 3 * static_cast<std::ptrdiff_t>(k)));
    }
  }
}

struct LegView {
  TwoBonePose pose;
  Vec3 toes;
  Quat foot;
};
LegView view(const PlacedCharacter& placed, const LimbChain& chain, double time) {
  const auto nodes = nodes_at(placed, time);
  Vec3 toes = Vec3::Zero();
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (placed.character.nodes[n].parent == chain.end) toes = place_of(nodes[n]);
  return {{place_of(nodes[at(chain.upper)]), place_of(nodes[at(chain.lower)]), place_of(nodes[at(chain.end)])},
          toes - place_of(nodes[at(chain.end)]),
          decompose(nodes[at(chain.end)]).rotation};
}

TEST(Adjust, Planted_feet_stay_while_the_body_sinks) {
  for (const MovedCase& c : moved_cases()) {
    FT_PLACE(placed, c);
    MotionAdjustment adjustment = adjustment_of(*placed);
    adjustment.limbs = legs_of(c, *placed);
    ASSERT_EQ(adjustment.limbs.size(), 2u);
    const double start = placed->playback.start;
    adjustment.deviation = [&](double time) {
      return RootDeviation{.displacement = std::clamp((time - start) / 0.2, 0.0, 1.0) * Vec3(0, -0.06, 0)};
    };
    for (AdjustedLimb& limb : adjustment.limbs)
      limb.target = [](double, const Vec3& imported) { return LimbTarget{imported, 1}; };
    // Four keys in a frame: a knee that leaves its straight pose moves far between two frames.
    adjustment.frame_time /= 4, adjustment.frame_count *= 4;
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    EXPECT_LT(motion->worst_miss, 1e-6);
    PlacedCharacter moved = *placed;
    ASSERT_TRUE(apply_changes(moved.character, moved.clip, motion->channels));
    double ankle = 0, foot = 0, length = 0, unit = 0;
    for (const ChangedChannel& channel : motion->channels)
      for (std::size_t k = 0; channel.track.width == 4 && k < channel.track.values.size(); k += 4)
        unit = std::max(unit, std::abs(Eigen::Map<const Eigen::Vector4d>(&channel.track.values[k]).norm() - 1));
    for (const AdjustedLimb& limb : adjustment.limbs)
      for (double time = start; time < start + 0.6; time += 0.013) {
        const LegView a = view(*placed, limb.chain, time), b = view(moved, limb.chain, time);
        ankle = std::max(ankle, (a.pose.end - b.pose.end).norm());
        foot = std::max(foot, a.foot.angularDistance(b.foot));
        length =
            std::max({length, std::abs((a.pose.lower - a.pose.upper).norm() - (b.pose.lower - b.pose.upper).norm()),
                      std::abs((a.pose.end - a.pose.lower).norm() - (b.pose.end - b.pose.lower).norm())});
        // The knee goes further to where it was, which is forwards where the foot is not stretched.
        const auto knee = [](const TwoBonePose& p) {
          const Vec3 line = (p.end - p.upper).normalized(), out = p.lower - p.upper;
          return Vec3(out - line * line.dot(out));
        };
        const Vec3 was = knee(a.pose), is = knee(b.pose), line = (b.pose.end - b.pose.upper).normalized();
        if (was.norm() > 0.02) {
          EXPECT_GT(is.normalized().dot(was.normalized()), 0.9) << time;
        }
        if (std::abs(line.dot(b.toes)) < 0.7 * b.toes.norm() && is.norm() > 0.02) {
          EXPECT_GT(is.dot(b.toes), 0) << time;
        }
        if (time > start + 0.2) {
          EXPECT_GT(is.norm(), was.norm() + 0.01) << time;
        }
      }
    std::printf("%s: ankle %.2e m, foot %.2e rad, lengths %.2e m, root took %.3f m\n", c.name, ankle, foot, length,
                motion->root_rest);
    EXPECT_LT(ankle, 1e-3);
    EXPECT_LT(foot, 2e-2);
    EXPECT_LT(length, 1e-6);
    EXPECT_LT(unit, 2e-7);
  }
}

TEST(Adjust, What_a_leg_cannot_reach_the_root_goes_to_meet) {
  for (const MovedCase& c : moved_cases()) {
    FT_PLACE(placed, c);
    MotionAdjustment adjustment = adjustment_of(*placed);
    adjustment.limbs = legs_of(c, *placed);
    adjustment.limbs.resize(1);
    const Vec3 lift(0.1, 0.5, 0);
    adjustment.deviation = [&](double) { return RootDeviation{.displacement = lift}; };
    adjustment.limbs[0].target = [](double, const Vec3& imported) { return LimbTarget{imported, 1}; };
    auto motion = adjust_motion(placed->character, placed->clip, placed->placement, adjustment);
    ASSERT_TRUE(motion) << motion.error().text();
    EXPECT_LT(motion->worst_miss, 1e-6);
    EXPECT_GT(motion->root_rest, 0.05);
    EXPECT_LT(motion->root_rest, lift.norm());
    PlacedCharacter moved = *placed;
    ASSERT_TRUE(apply_changes(moved.character, moved.clip, motion->channels));
    const BendLimits limits;
    for (int f = 0; f < adjustment.frame_count && f < 20; ++f) {
      const double time = adjustment.first_frame + f * adjustment.frame_time;
      const TwoBonePose a = view(*placed, adjustment.limbs[0].chain, time).pose;
      const TwoBonePose b = view(moved, adjustment.limbs[0].chain, time).pose;
      const auto bend = [](const TwoBonePose& p) {
        const Vec3 x = p.lower - p.upper, y = p.end - p.lower;
        return std::atan2(x.cross(y).norm(), x.dot(y));
      };
      EXPECT_LT((a.end - b.end).norm(), 1e-4) << time;  // a nearly straight leg between keys and frames 0.1 ms apart
      EXPECT_GT(bend(b), std::min(limits.least, bend(a)) - 1e-3) << time;
      EXPECT_GT((b.upper - a.upper).norm(), 0) << time;
    }
  }
}

TEST(Adjust, Says_what_cannot_be_moved) {
  const MovedCase c = moved_cases()[1];
  FT_PLACE(placed, c);
  const auto fault = [&](auto&& edit) {
    MotionAdjustment adjustment = adjustment_of(*placed);
    adjustment.limbs = legs_of(c, *placed);
    int clip = placed->clip;
    Character character = placed->character;
    edit(adjustment, character, clip);
    auto motion = adjust_motion(character, clip, placed->placement, adjustment);
    return motion ? std::string("no fault") : motion.error().text();
  };
  using A = MotionAdjustment;
  const auto has = [](const std::string& text, const char* part) { return text.find(part) != std::string::npos; };
  EXPECT_PRED2(has, fault([](A&, Character&, int& clip) { clip = 99; }), "clip 99");
  EXPECT_PRED2(has, fault([](A& a, Character&, int&) { a.roots = {-1}; }), "root");
  EXPECT_PRED2(has, fault([](A& a, Character&, int&) { a.frame_time = 0; }), "above 0");
  EXPECT_PRED2(has, fault([](A& a, Character&, int&) { std::swap(a.limbs[0].chain.upper, a.limbs[0].chain.end); }),
               "no chain");
  EXPECT_PRED2(has, fault([](A& a, Character&, int&) { a.limbs[1] = a.limbs[0]; }), "moved twice");
  EXPECT_PRED2(has, fault([](A& a, Character&, int&) {
                 a.deviation = [](double) { return RootDeviation{.displacement = Vec3(0, NAN, 0)}; };
               }),
               "not finite");
  EXPECT_PRED2(has, fault([](A& a, Character& character, int&) {
                 const int parent = character.nodes[at(a.roots[0])].parent;
                 character.nodes[at(parent)].local.col(0) *= 2;
                 a.deviation = [](double) {
                   return RootDeviation{.rotation = Quat(Eigen::AngleAxisd(0.5, Vec3::UnitZ()))};
                 };
               }),
               "scaled unequally");
  EXPECT_PRED2(has, find_limb(placed->character, "DEF-thigh.L", "DEF-shin", "DEF-foot.L").error().text(),
               "did you mean");
  EXPECT_PRED2(has, find_limb(placed->character, "DEF-thigh.L", "DEF-shin.R", "DEF-foot.L").error().text(),
               "not one above");
}

TEST(TwoBone, Reaches_what_is_in_reach_and_points_at_what_is_not) {
  const TwoBonePose pose{{0, 1, 0}, {0.02, 0.55, 0.1}, {0, 0.1, 0}};
  const BendLimits limits;
  const double a = (pose.lower - pose.upper).norm(), b = (pose.end - pose.lower).norm();
  const auto moved = [&](const TwoBoneTurn& t) {
    const Vec3 lower = pose.upper + t.upper * (pose.lower - pose.upper);
    return TwoBonePose{pose.upper, lower, lower + t.upper * (t.lower * (pose.end - pose.lower))};
  };
  const Reach reach = reach_of(pose, limits);
  EXPECT_NEAR(reach.most, std::sqrt(a * a + b * b + 2 * a * b * std::cos(limits.least)), 1e-12);
  EXPECT_NEAR(reach.least, std::sqrt(a * a + b * b + 2 * a * b * std::cos(limits.most)), 1e-12);
  for (int k = 0; k < 200; ++k) {
    const Vec3 target = pose.upper + (0.1 + 0.006 * k) * Vec3(std::sin(0.1 * k), -1.2, std::cos(0.37 * k)).normalized();
    const TwoBonePose is = moved(bend_to(pose, target, Vec3::UnitX(), limits));
    EXPECT_NEAR((is.lower - is.upper).norm(), a, 1e-12);
    EXPECT_NEAR((is.end - is.lower).norm(), b, 1e-12);
    const Vec3 way = target - pose.upper;
    const double r = std::clamp(way.norm(), reach.least, reach.most);
    EXPECT_LT((is.end - pose.upper - r * way.normalized()).norm(), 1e-9);
  }
  // Where it is already, nothing turns; what is nearly straight bends about the usual axis.
  const TwoBoneTurn none =
      bend_to(pose, pose.end, (pose.lower - pose.upper).cross(pose.end - pose.lower).normalized(), limits);
  EXPECT_LT(none.upper.angularDistance(Quat::Identity()) + none.lower.angularDistance(Quat::Identity()), 1e-7);
  const TwoBonePose straight{{0, 1, 0}, {0, 0.5, 0}, {0, 0, 0}};
  const TwoBoneTurn forward = bend_to(straight, {0, 0.1, 0}, Vec3::UnitX(), limits);
  EXPECT_GT((forward.upper * Vec3(0, -1, 0)).z(), 0.2);
}

}  // namespace
}  // namespace ft::test

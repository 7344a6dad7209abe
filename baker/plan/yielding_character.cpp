#include "baker/plan/yielding_character.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/core/smooth_step.h"
#include "baker/plan/driven_body.h"
#include "baker/plan/located.h"
#include "baker/plan/primary_mass.h"
#include "io/shot/shot_values.h"

namespace ft::inline baker {
namespace {

constexpr double k_longest_step = 1.0 / 240;               ///< between samples of the deviation [s]
constexpr double k_point = 0.1;                            ///< size of a body point, of the body's height [1]
constexpr double k_sole_point = 0.035;                     ///< the same of the soles
constexpr double k_sole_share = 0.3;                       ///< of a foot's height, from below, is sole
constexpr double k_miss = 1e-3;                            ///< that a planted foot may be off before it is told [m]
constexpr double k_on_ground = 0.03, k_off_ground = 0.08;  ///< heights of a sole that stands, and that does not [m]

/// What carries a vertex: the node with its largest weight.
std::vector<int> node_of_vertex(const Skin& skin) {
  std::vector<int> out(at(skin.surface.vertex_count()), -1);
  for (std::size_t v = 0; v < out.size(); ++v) {
    double most = 0;
    for (int row = skin.start[v]; row < skin.start[v + 1]; ++row)
      if (skin.weight[at(row)] > most)
        most = skin.weight[at(row)], out[v] = skin.bindings[at(skin.binding[at(row)])].node;
  }
  return out;
}

bool is_below(const Character& character, int node, int ancestor) {
  while (node > ancestor) node = character.nodes[at(node)].parent;
  return node == ancestor;
}

/// A foot: the leg that it ends, and the underside of its skin.
struct Foot {
  LimbChain leg;
  std::vector<Triangle> sole;
};

/// Feet by the names of the joints; the sole is what faces down, low on the foot, in the bind pose.
std::vector<Foot> find_feet(const PlacedCharacter& placed, std::span<const Vec3> bind) {
  const std::vector<Limb> limbs = limbs_by_name(placed.character);
  const std::vector<int> nodes = node_of_vertex(placed.skin);
  std::vector<Foot> out;
  for (const LimbChain& chain : find_limbs(placed.character)) {
    if (limbs[at(chain.end)] != Limb::k_foot) continue;
    const auto on_foot = [&](int vertex) {
      return nodes[at(vertex)] >= 0 && is_below(placed.character, nodes[at(vertex)], chain.end);
    };
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t v = 0; v < bind.size(); ++v)
      if (on_foot(static_cast<int>(v))) low = std::min(low, bind[v].y()), high = std::max(high, bind[v].y());
    Foot foot{chain, {}};
    for (const Triangle& t : placed.skin.surface.triangles) {
      if (!on_foot(t[0]) || !on_foot(t[1]) || !on_foot(t[2])) continue;
      const Vec3 &a = bind[at(t[0])], &b = bind[at(t[1])], &c = bind[at(t[2])];
      const Vec3 cross = (b - a).cross(c - a);
      if (-cross.y() > 0.5 * cross.norm() && (a.y() + b.y() + c.y()) / 3 < low + k_sole_share * (high - low))
        foot.sole.push_back(t);
    }
    if (!foot.sole.empty()) out.push_back(std::move(foot));
  }
  return out;
}

/// Lowest point of each sole at every frame.
std::vector<std::vector<Vec3>> lowest_points(const std::vector<Foot>& feet, const Trajectory& trajectory,
                                             int frame_count, double fps) {
  std::vector<std::vector<Vec3>> out(feet.size());
  std::vector<Vec3> x(at(trajectory.surface().vertex_count()));
  for (int f = 0; f < frame_count; ++f) {
    trajectory.sample(f / fps, x);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      Vec3 lowest = x[at(feet[i].sole[0][0])];
      for (const Triangle& t : feet[i].sole)
        for (const int v : t)
          if (x[at(v)].y() < lowest.y()) lowest = x[at(v)];
      out[i].push_back(lowest);
    }
  }
  return out;
}

/// How far up a mat's top is at a place; the ground beside it.
struct Ground {
  double level = 0;
  bool is_mat = false;
};
Ground ground_at(const Vec3& place, std::span<const StandInKeys* const> stand_ins, double ground) {
  for (const StandInKeys* mat : stand_ins) {
    if (mat->kind != "mat") continue;
    const Vec3 away = (place - mat->position).cwiseAbs();
    if (mat->size.isZero(0) || (2 * away.x() <= mat->size.x() && 2 * away.z() <= mat->size.z()))
      return {mat->position.y(), true};
  }
  return {ground, false};
}

/// Legs that hold their feet where they stand. Into a mat they sink with the body and are not lifted from it.
std::vector<AdjustedLimb> planted_legs(const Shot& shot, const std::vector<const StandInKeys*>& stand_ins,
                                       const std::vector<Foot>& feet, const Trajectory& trajectory,
                                       const HybridPass& pass, const Playback& playback) {
  const int frame_count = static_cast<int>(pass.frames.size());
  const double fps = shot.fps;
  auto lowest = lowest_points(feet, trajectory, frame_count, fps);
  double ground = std::numeric_limits<double>::infinity();
  for (const auto& points : lowest)
    for (const Vec3& p : points) ground = std::min(ground, p.y());
  std::vector<AdjustedLimb> out;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    std::vector<double> weight, sinks;
    for (const Vec3& p : lowest[i]) {
      const Ground under = ground_at(p, stand_ins, ground);
      weight.push_back(1 - smooth_step((p.y() - under.level - k_on_ground) / (k_off_ground - k_on_ground)));
      sinks.push_back(under.is_mat ? 1 : 0);
    }
    AdjustedLimb limb;
    limb.chain = feet[i].leg;
    limb.target = [weight, sinks, fps, playback, pass = &pass](double time, const Vec3& imported) {
      const double shot_time = (time - playback.start) / playback.speed;
      const double place = std::clamp(shot_time * fps, 0.0, static_cast<double>(weight.size() - 1));
      const auto f = static_cast<std::size_t>(place), next = std::min(f + 1, weight.size() - 1);
      const double s = place - static_cast<double>(f);
      const auto between = [&](const std::vector<double>& v) { return (1 - s) * v[f] + s * v[next]; };
      const double down = std::min(0.0, pass->offset(shot_time).position.y());
      return LimbTarget{imported + between(sinks) * down * Vec3::UnitY(), between(weight)};
    };
    out.push_back(std::move(limb));
  }
  return out;
}

/// What stand-ins meet: of a character on a mat its soles, whose whole underside the mat's stiffness is for.
std::vector<BodyPoint> points_of(const PlacedCharacter& placed, const std::vector<const StandInKeys*>& stand_ins,
                                 const std::vector<Foot>& feet, std::span<const Vec3> bind, double mass) {
  const double height = bounds(bind).size().maxCoeff();
  const Surface& surface = placed.skin.surface;
  const bool on_mat =
      std::any_of(stand_ins.begin(), stand_ins.end(), [](const StandInKeys* s) { return s->kind == "mat"; });
  if (on_mat && !feet.empty()) {
    std::vector<Triangle> soles;
    for (const Foot& foot : feet) soles.insert(soles.end(), foot.sole.begin(), foot.sole.end());
    return body_points(surface, bind, soles, k_sole_point * height, 0);
  }
  return body_points(surface, bind, surface.triangles, k_point * height, mass / k_body_density);
}

}  // namespace

bool has_joints(const PlacedCharacter& placed) {
  const auto& meshes = placed.character.meshes;
  return std::any_of(meshes.begin(), meshes.end(), [](const CharacterMesh& mesh) { return mesh.bones.size() > 1; });
}

Result<YieldedCharacter> yield_character(const Shot& shot, const PrimarySpec& spec, const ImportRequest& request,
                                         std::shared_ptr<const PlacedCharacter> character, const Trajectory& trajectory,
                                         double mass) {
  const auto at_primary = [&](const Error& error) { return located(error, shot, "primary " + in_quotes(spec.name)); };
  const PlacedCharacter& placed = *character;
  if (placed.clip < 0)
    return at_primary(usage_error("plays no clip: there is no motion that could yield", {},
                                  "name one of its clips, or the file with its animation"));
  const std::vector<Vec3> bind = bind_pose_of(trajectory);
  const std::vector<const StandInKeys*> stand_ins = stand_ins_of(shot, spec.name);
  const std::vector<Foot> feet = find_feet(placed, bind);
  const int frame_count = shot.last_frame - shot.first_frame + 1;

  YieldedCharacter out;
  auto pass = hybrid_pass(
      shot, spec, driven_body(trajectory, points_of(placed, stand_ins, feet, bind, mass), mass, frame_count, shot.fps),
      k_longest_step, Vec3::Zero());
  if (!pass) return pass.error();
  out.pass = std::move(*pass);

  MotionAdjustment adjustment;
  adjustment.roots = motion_roots(placed.character, placed.clip, {});
  adjustment.first_frame = placed.playback.start;
  adjustment.frame_time = placed.playback.speed / shot.fps;
  adjustment.frame_count = frame_count;
  adjustment.deviation = [&](double time) {
    const RigidPose offset = out.pass.offset((time - placed.playback.start) / placed.playback.speed);
    return RootDeviation{offset.position, offset.rotation, Vec3::Zero()};
  };
  if (spec.limbs == "planted") {
    if (feet.empty())
      return at_primary(usage_error("limbs = \"planted\", but no legs are found by the names of its joints", {},
                                    "write limbs = \"rigid\""));
    adjustment.limbs = planted_legs(shot, stand_ins, feet, trajectory, out.pass, placed.playback);
  }
  auto motion = adjust_motion(placed.character, placed.clip, placed.placement, adjustment);
  if (!motion) return at_primary(motion.error());
  if (motion->worst_miss > k_miss)
    out.notes.push_back(
        fmt::format("planted feet of \"{}\" are up to {:.3g} mm from their places: its legs do not "
                    "reach them all",
                    spec.name, 1e3 * motion->worst_miss));

  PlacedCharacter moved = placed;
  if (Status s = apply_changes(moved.character, moved.clip, motion->channels); !s) return at_primary(s.error());
  auto played = play(std::move(moved), request);
  if (!played) return at_primary(played.error());
  out.trajectory = std::move(played->trajectory);
  out.character = {request,
                   std::move(character),
                   std::move(*motion),
                   {placed.playback.start, placed.playback.speed / shot.fps, frame_count}};
  return out;
}

}  // namespace ft::inline baker

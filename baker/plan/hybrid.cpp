#include "baker/plan/hybrid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/plan/located.h"
#include "io/shot/mesh_file.h"
#include "io/shot/shot_values.h"
#include "solvers/standins/registry.h"

namespace ft::inline baker {
namespace {

constexpr double k_without_end = 2e4;  ///< of a mat whose size is not given [m]

std::vector<std::string> stood_in_for(const Shot& shot, const std::string& primary) {
  std::vector<std::string> out;
  for (const auto& s : shot.secondaries)
    if (s->on == primary && s->coupling == "hybrid") out.push_back(s->name);
  return out;
}

DeviationSettings settings_of(const Shot& shot, const PrimarySpec& spec) {
  DeviationSettings out;
  out.gravity = shot.solver.gravity;
  out.comeback = spec.comeback == "spring"   ? Comeback::k_spring
                 : spec.comeback == "window" ? Comeback::k_window
                 : spec.comeback == "hold"   ? Comeback::k_hold
                                             : Comeback::k_free;
  out.omega = 2 * std::numbers::pi * spec.comeback_frequency;
  out.zeta = spec.comeback_damping_ratio;
  out.window = spec.comeback_window;
  if (spec.max_displacement) out.max_displacement = *spec.max_displacement;
  if (spec.max_acceleration) out.max_acceleration = *spec.max_acceleration;
  return out;
}

}  // namespace

std::vector<std::string> HybridPass::lines(const std::string& primary) const {
  std::vector<std::string> out{text(primary)};
  out.insert(out.end(), notes.begin(), notes.end());
  return out;
}

std::string HybridPass::text(const std::string& primary) const {
  std::string of;
  for (const std::string& name : names) of += (of.empty() ? "\"" : "\", \"") + name;
  return fmt::format(
      "hybrid pass: \"{}\" meets the stand-ins of {}\" with at most {:.3g} N, which do {:.3g} J of work on it, and "
      "goes up to {:.4g} m from its path",
      primary, of, largest.force.norm(), work, largest_displacement);
}

RigidPose HybridPass::offset(double time) const {
  if (!(time > 0)) return {};
  const double place = std::min(time / dt, static_cast<double>(offsets.size() - 1));
  const auto i = static_cast<std::size_t>(place);
  const double s = place - static_cast<double>(i);
  if (s == 0) return offsets[i];
  RigidPose out;
  out.position = (1 - s) * offsets[i].position + s * offsets[i + 1].position;
  out.rotation = offsets[i].rotation.slerp(s, offsets[i + 1].rotation);
  return out;
}

std::vector<const StandInKeys*> stand_ins_of(const Shot& shot, const std::string& primary) {
  const std::vector<std::string> names = stood_in_for(shot, primary);
  std::vector<const StandInKeys*> out;
  for (const StandInKeys& keys : shot.standins)
    if (keys.on == primary || std::find(names.begin(), names.end(), keys.stands_for) != names.end())
      out.push_back(&keys);
  return out;
}

bool is_hybrid(const Shot& shot, const std::string& primary) {
  return !stood_in_for(shot, primary).empty() || !stand_ins_of(shot, primary).empty();
}

Result<StandInSpec> stand_in_spec(const StandInKeys& k, const Shot& shot) {
  StandInSpec out;
  out.name = k.name;
  out.kind = k.kind;
  out.stands_for = k.stands_for;
  out.support = k.support == "replace" ? Support::k_replace : Support::k_add;
  out.gain = k.gain;
  const auto time = [&](double frame) { return (frame - shot.first_frame) / shot.fps; };
  if (k.from) out.from = time(*k.from);
  if (k.until) out.until = time(*k.until);
  if (k.limit_force) out.limit_force = *k.limit_force;
  out.shape = k.shape == "cone" ? VolumeShape::k_cone : k.shape == "mesh" ? VolumeShape::k_mesh : VolumeShape::k_box;
  out.position = k.kind == "spring" ? k.anchor : k.position;
  out.size = k.kind == "mat" && k.size.isZero(0) ? Vec3::Constant(k_without_end) : k.size;
  out.radius_top = k.radius_top;
  out.radius_bottom = k.radius_bottom;
  out.height = k.height;
  if (!k.mesh.empty()) {
    auto mesh = read_obj(k.mesh);
    if (!mesh) return mesh.error();
    out.mesh = std::move(*mesh);
  }
  out.soft_edge = k.soft_edge;
  out.damping = k.damping;
  out.damping_quadratic = k.damping_quadratic;
  out.damping_spin = k.damping_spin;
  out.stiffness = k.stiffness;
  out.stiffness_cubic = k.stiffness_cubic;
  out.damping_ratio = k.damping_ratio.value_or(0);
  out.density = k.density;
  out.drag = k.drag;
  out.slam = k.slam;
  out.length = k.length;
  out.mass = k.mass;
  return out;
}

Result<HybridPass> hybrid_pass(const Shot& shot, const PrimarySpec& spec, YieldingBody body, double longest_step,
                               const Vec3& turn_axes) {
  const auto at_primary = [&](const Error& error) { return located(error, shot, "primary " + in_quotes(spec.name)); };
  HybridPass out;
  out.names = stood_in_for(shot, spec.name);
  std::vector<std::unique_ptr<StandIn>> stand_ins;
  for (const StandInKeys* keys : stand_ins_of(shot, spec.name)) {
    auto made_of = stand_in_spec(*keys, shot);
    if (!made_of) return at_primary(made_of.error());
    auto made = make_stand_in(*made_of);
    if (!made) return at_primary(made.error());
    stand_ins.push_back(std::move(*made));
    if (!keys->on.empty()) out.names.push_back(keys->name);
  }
  if (!(body.mass.mass > 0))
    return at_primary(usage_error("a hybrid pass needs the primary's mass", "", "write mass, in kg"));
  out.mass = body.mass.mass;
  out.settings = settings_of(shot, spec);
  out.settings.turn_axes = turn_axes;
  auto deviation = Deviation::make(std::move(body), std::move(stand_ins), out.settings);
  if (!deviation) return at_primary(deviation.error());

  const int pieces = std::max(1, static_cast<int>(std::ceil(1 / (shot.fps * longest_step) - 1e-9)));
  out.dt = 1 / (shot.fps * pieces);
  DeviationState state = deviation->start(0);
  out.motion.push_back(deviation->adjusted(state));
  out.offsets.push_back(state.offset);
  out.frames.push_back({shot.first_frame, {}, 0, 0, {}});
  for (int frame = shot.first_frame; frame < shot.last_frame; ++frame) {
    HybridFrame now{frame + 1, {}, 0, 0, {}};
    for (int piece = 1; piece <= pieces; ++piece) {
      const auto step = deviation->advance(state, (frame - shot.first_frame) / shot.fps + piece * out.dt);
      if (!step) return at_primary(step.error());
      out.motion.push_back(step->motion);
      out.offsets.push_back(state.offset);
      now.mean += (1.0 / pieces) * step->wrench;
      now.peak = std::max(now.peak, step->peak);
      now.work += step->work;
    }
    now.offset = state.offset;
    out.work += now.work;
    if (now.mean.force.norm() > out.largest.force.norm()) out.largest = now.mean;
    out.largest_displacement = std::max(out.largest_displacement, state.offset.position.norm());
    out.frames.push_back(now);
  }
  for (const std::string& name : deviation->untouched(state))
    out.notes.push_back(
        fmt::format("standin \"{}\" never touches \"{}\": is it where \"{}\" is?", name, spec.name, out.names.front()));
  return out;
}

}  // namespace ft::inline baker

#include "baker/hybrid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/shot/mesh_file.h"
#include "solvers/standins/deviation.h"
#include "solvers/standins/registry.h"

namespace ft {
namespace {

constexpr double k_longest_step = 1.0 / 600;  ///< between samples of the adjusted track [s]

std::vector<std::string> stood_in_for(const Shot& shot, const std::string& primary) {
  std::vector<std::string> out;
  for (const ClothSpec& c : shot.cloths)
    if (c.on == primary && c.coupling == "hybrid") out.push_back(c.name);
  for (const CordsSpec& c : shot.cords)
    if (c.on == primary && c.coupling == "hybrid") out.push_back(c.name);
  return out;
}

}  // namespace

std::string HybridPass::text(const std::string& primary) const {
  std::string of;
  for (const std::string& name : names) of += (of.empty() ? "\"" : "\", \"") + name;
  return fmt::format(
      "hybrid pass: \"{}\" meets the stand-ins of {}\" with at most {:.3g} N, which do {:.3g} J of work on it, and "
      "goes up to {:.4g} m from its path",
      primary, of, largest.force.norm(), work, largest_displacement);
}

bool is_hybrid(const Shot& shot, const std::string& primary) {
  return !stood_in_for(shot, primary).empty();
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
  out.size = k.size;
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

Result<HybridPass> hybrid_pass(const Shot& shot, const Prop& prop) {
  const auto located = [&](Error error) {
    error.where = shot.file.filename().string() + ": primary \"" + prop.name + "\"" +
                  (error.where.empty() ? "" : ": " + error.where);
    return error;
  };
  HybridPass out;
  out.names = stood_in_for(shot, prop.name);
  std::vector<std::unique_ptr<StandIn>> stand_ins;
  for (const StandInKeys& keys : shot.standins) {
    if (std::find(out.names.begin(), out.names.end(), keys.stands_for) == out.names.end()) continue;
    auto spec = stand_in_spec(keys, shot);
    if (!spec) return located(spec.error());
    auto made = make_stand_in(*spec);
    if (!made) return located(made.error());
    stand_ins.push_back(std::move(*made));
  }
  if (!(prop.mass.mass > 0))
    return located(usage_error("a hybrid pass needs the primary's mass", "", "write mass, in kg"));
  DrivenBody body{prop.mass, prop.track, [samples = prop.samples](double) { return std::span(samples); }};
  DeviationSettings settings;
  settings.gravity = shot.solver.gravity;
  auto deviation = Deviation::make(std::move(body), std::move(stand_ins), settings);
  if (!deviation) return located(deviation.error());

  const int pieces = std::max(1, static_cast<int>(std::ceil(1 / (shot.fps * k_longest_step) - 1e-9)));
  const double dt = 1 / (shot.fps * pieces);
  DeviationState state = deviation->start(0);
  std::vector<RigidMotion> samples{deviation->adjusted(state)};
  for (int frame = shot.first_frame; frame < shot.last_frame; ++frame) {
    Wrench mean;
    for (int piece = 1; piece <= pieces; ++piece) {
      const auto step = deviation->advance(state, (frame - shot.first_frame) / shot.fps + piece * dt);
      if (!step) return located(step.error());
      samples.push_back(step->motion);
      mean += (1.0 / pieces) * step->wrench;
      out.work += step->work;
    }
    if (mean.force.norm() > out.largest.force.norm()) out.largest = mean;
    out.largest_displacement = std::max(out.largest_displacement, state.offset.position.norm());
  }
  for (const std::string& name : deviation->untouched(state))
    out.notes.push_back(
        fmt::format("standin \"{}\" never touches \"{}\": is it where \"{}\" is?", name, prop.name, out.names.front()));
  out.track = [before = prop.track, after = sampled_motion(0, dt, std::move(samples))](double time) {
    return time < 0 ? before(time) : after(time);
  };
  return out;
}

}  // namespace ft

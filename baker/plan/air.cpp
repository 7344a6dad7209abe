#include "baker/plan/air.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/plan/located.h"
#include "io/shot/patterns.h"
#include "io/shot/words.h"
#include "solvers/wind/body_paths.h"
#include "solvers/wind/registry.h"
#include "solvers/wind/surface_shelter.h"
#include "solvers/wind/velocity_grid.h"

namespace ft::inline baker {
namespace {

/// Those of the parts that the patterns mean, empty for all.
Result<std::vector<int>> parts_like(std::span<const std::string> patterns, const Surface& surface) {
  std::vector<std::string> names;
  for (const SurfacePart& part : surface.parts) names.push_back(part.name);
  if (patterns.empty()) return std::vector<int>();
  return indices_like(patterns, names, "parts", "part");
}

Result<std::shared_ptr<const BodyPaths>> plan_bodies(const Shot& shot, const WindKeys& keys, const PrimaryPlan& primary,
                                                     std::vector<std::string>& notes) {
  PathRequest request;
  request.first_time = -shot.preroll / shot.fps;
  request.last_time = (shot.last_frame - shot.first_frame) / shot.fps;
  request.fps = shot.fps;
  for (const Teleport& teleport : primary.scan.teleports)
    request.jumps.push_back((teleport.frame - shot.first_frame - 0.5) / shot.fps);
  auto parts = parts_like(keys.parts, primary.trajectory->surface());
  if (!parts) return parts.error();
  request.parts = std::move(*parts);
  request.drag_area = keys.drag_area.value_or(0);
  auto out = std::make_shared<BodyPaths>(paths_of(*primary.trajectory, request));
  double area = 0;
  for (const BodyPath& path : out->paths()) area += path.drag_area;
  if (!keys.drag_area)
    notes.push_back(
        fmt::format("wind \"{}\": drag area {:.2g} m2, guessed from the surface of \"{}\" (drag_area says it)",
                    keys.name, area, keys.of));
  if (out->fastest() < 0.1)
    notes.push_back(fmt::format("wind \"{}\": \"{}\" hardly moves in this shot, and has no wake", keys.name, keys.of));
  return std::shared_ptr<const BodyPaths>(std::move(out));
}

Result<WindFieldSpec> field_spec(const Shot& shot, const WindKeys& k, std::span<const PrimaryPlan> primaries,
                                 std::vector<std::string>& notes) {
  WindFieldSpec out;
  out.name = k.name;
  out.kind = k.kind;
  out.gain = k.gain;
  const auto time = [&](double frame) { return (frame - shot.first_frame) / shot.fps; };
  if (k.from) out.from = time(*k.from);
  if (k.until) out.until = time(*k.until);
  out.fade = k.fade / shot.fps;
  out.velocity = k.velocity;
  out.gusts = k.gusts;
  out.gust_time = k.gust_time;
  out.position = k.position;
  out.axis = k.axis;
  out.flow = k.flow;
  out.circulation = k.circulation;
  out.radius = k.radius;
  out.intensity = k.intensity;
  out.length = k.length;
  out.seed = static_cast<std::uint64_t>(k.seed);
  out.turbulence = k.turbulence;
  if (k.kind == "wake")
    for (const PrimaryPlan& primary : primaries) {
      if (primary.name != k.of) continue;
      auto bodies = plan_bodies(shot, k, primary, notes);
      if (!bodies) return bodies.error();
      out.bodies = std::move(*bodies);
    }
  return out;
}

}  // namespace

Result<std::shared_ptr<const Wind>> plan_wind(const Shot& shot, std::span<const PrimaryPlan> primaries,
                                              std::vector<std::string>& notes) {
  auto out = std::make_shared<Wind>();
  if (shot.wind.velocity != Vec3::Zero()) {
    WindFieldSpec steady;
    steady.name = "wind";
    steady.kind = "uniform";
    steady.velocity = shot.wind.velocity;
    auto field = make_wind_field(steady);
    if (!field) return field.error();
    out->add(std::move(*field));
  }
  for (const WindKeys& keys : shot.winds) {
    const std::string owner = "wind \"" + keys.name + "\"";
    auto spec = field_spec(shot, keys, primaries, notes);
    if (!spec) return located(spec.error(), shot, owner);
    auto field = make_wind_field(*spec);
    if (!field) return located(field.error(), shot, owner);
    out->add(std::move(*field));
  }
  for (const PrimarySpec& spec : shot.primaries)
    for (const PrimaryPlan& primary : primaries)
      if (spec.blocks_wind && primary.name == spec.name) out->add(std::make_shared<SurfaceShelter>(primary.trajectory));
  const bool any_blocks = std::any_of(shot.primaries.begin(), shot.primaries.end(),
                                      [](const PrimarySpec& spec) { return spec.blocks_wind; });
  if (any_blocks && out->is_still()) notes.push_back("blocks_wind: no wind blows in this shot");
  return std::shared_ptr<const Wind>(std::move(out));
}

std::vector<std::string> wind_lines(const Shot& shot, const Wind& wind) {
  std::vector<std::string> out;
  for (const auto& field : wind.fields()) {
    const WindFieldSpec& spec = field->spec();
    std::string when;
    const auto frame = [&](double time) { return shot.first_frame + time * shot.fps; };
    if (std::isfinite(spec.from)) when += fmt::format(", from frame {:g}", frame(spec.from));
    if (std::isfinite(spec.until)) when += fmt::format(", until frame {:g}", frame(spec.until));
    out.push_back(fmt::format("wind \"{}\": {}, nowhere faster than {:.2g} m/s{}", spec.name, spec.kind,
                              spec.gain * field->fastest(), when));
  }
  return out;
}

}  // namespace ft::inline baker

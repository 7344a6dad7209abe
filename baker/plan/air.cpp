#include "baker/plan/air.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/plan/located.h"
#include "baker/plan/meets.h"
#include "io/shot/patterns.h"
#include "io/volume/vdb_read.h"
#include "solvers/wind/body_paths.h"
#include "solvers/wind/log_profile.h"
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
  auto paths = paths_of(*primary.trajectory, request);
  if (!paths) return paths.error();
  auto out = std::make_shared<BodyPaths>(std::move(*paths));
  double area = 0;
  for (const BodyPath& path : out->paths()) area += path.drag_area;
  if (!keys.drag_area)
    notes.push_back(
        fmt::format("wind \"{}\": drag area {:.2g} m2, guessed from the surface of \"{}\" (drag_area says it)",
                    keys.name, area, keys.of));
  if (is_two_way(shot, primary.name))
    notes.push_back(fmt::format("wind \"{}\": the wake is that of \"{}\" as it would move without its secondaries",
                                keys.name, keys.of));
  if (out->fastest() < 0.1)
    notes.push_back(fmt::format("wind \"{}\": \"{}\" hardly moves in this shot, and has no wake", keys.name, keys.of));
  return std::shared_ptr<const BodyPaths>(std::move(out));
}

/// Of a sequence the frames that the shot needs; file n is the shot's frame n.
Result<std::shared_ptr<const VelocityGrid>> plan_grid(const Shot& shot, const WindKeys& keys,
                                                      std::vector<std::string>& notes) {
  auto found = find_vdb_sequence(keys.file);
  if (!found) return found.error();
  const std::int64_t count = static_cast<std::int64_t>(found->files.size());
  const std::int64_t first = std::clamp<std::int64_t>(shot.first_frame - shot.preroll - found->first, 0, count - 1);
  const std::int64_t last = std::clamp<std::int64_t>(shot.last_frame - found->first, first, count - 1);
  if (count > 1 && (found->first > shot.first_frame || found->first + count - 1 < shot.last_frame))
    notes.push_back(fmt::format("wind \"{}\": has files for the frames {} to {}; before and after it stays as in these",
                                keys.name, found->first, found->first + count - 1));
  NumberedFiles needed{found->first + first, {found->files.begin() + first, found->files.begin() + last + 1}};
  auto frames = read_vdb_sequence(needed, keys.grid);
  if (!frames) return frames.error();
  std::vector<VelocityVoxels> voxels;
  for (VdbVelocity& frame : *frames) {
    to_metres(frame, keys.unit_scale, keys.up);
    for (const std::string& note : frame.notes) {
      const std::string said = "wind \"" + keys.name + "\": " + note;
      if (std::find(notes.begin(), notes.end(), said) == notes.end()) notes.push_back(said);
    }
    voxels.push_back({frame.lowest, frame.count, frame.to_world, std::move(frame.velocities)});
  }
  const double start = count > 1 ? static_cast<double>(needed.first - shot.first_frame) / shot.fps : 0;
  return std::shared_ptr<const VelocityGrid>(std::make_shared<VelocityGrid>(std::move(voxels), start, shot.fps));
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
  out.clock = shot.first_frame / shot.fps;
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
  if (k.kind == "grid") {
    auto grid = plan_grid(shot, k, notes);
    if (!grid) return grid.error();
    out.grid = std::move(*grid);
  }
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
    if (keys.roughness_length) {
      const LogProfile profile{*keys.roughness_length, keys.reference_height, keys.ground};
      const auto speed = [&](double above) {
        return keys.gain * keys.velocity.norm() * profile.share(keys.ground + above);
      };
      notes.push_back(fmt::format(
          "{}: slower near the ground, by the logarithmic law: {:.2g} m/s at 2 m above it, {:.2g} at 0.5 m, {:.2g} at "
          "0.05 m; {:.2g} m/s from {:g} m on",
          owner, speed(2), speed(0.5), speed(0.05), speed(profile.top()), profile.top()));
      *field = std::make_unique<ProfiledWind>(std::move(*field), profile);
    }
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

#include "baker/plan_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/shot/shot_maps.h"
#include "io/shot/shot_values.h"
#include "io/shot/words.h"
#include "solvers/cloth/attach.h"

namespace ft {
namespace {

std::string box_text(const Box& box) {
  const Vec3 size = box.size();
  return fmt::format("{:.4g} x {:.4g} x {:.4g} m", size.x(), size.y(), size.z());
}

std::uint64_t cache_bytes(const BakePlan& plan) {
  std::uint64_t sum = 0;
  const auto frames = static_cast<std::uint64_t>(plan.written_count());
  for (const GroupPlan& group : plan.groups) {
    for (const GarmentOutput& garment : group.outputs)
      for (const std::string& format : plan.shot().cache_formats)
        sum += frames * static_cast<std::uint64_t>(garment.mesh->vertex_count()) * (format == "pc2" ? 12 : 24);
    // Body as drawn, and the collider: about as many vertices again before refinement.
    if (plan.shot().cache_collider)
      sum += 2 * 12 * frames *
             static_cast<std::uint64_t>(plan.primaries[group.primary].trajectory->surface().vertex_count());
  }
  return sum;
}

/// "8 vertices held to "skirt", 2.1 to 7.9 mm from it".
std::string attachment_text(std::span<const ClothGarment> garments, const ClothGarment& own, const ClothPin& pin) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  int held = 0;
  for (const SurfacePoint& f : footholds(garments, static_cast<std::size_t>(&own - garments.data()), pin)) {
    if (f.triangle[0] < 0) continue;
    nearest = std::min(nearest, f.distance), farthest = std::max(farthest, f.distance);
    ++held;
  }
  return fmt::format("{} vertices held to \"{}\", {:.1f} to {:.1f} mm from it", held,
                     garments[static_cast<std::size_t>(pin.to)].name, 1e3 * nearest, 1e3 * farthest);
}

/// ", open by up to 310 mm, closed 1.2 s after the start".
std::string seam_text(const ClothGarment& garment, const ClothSetup& setup) {
  double widest = 0;
  const auto& x = garment.mesh.positions;
  for (const Stitch& s : garment.mesh.stitches)
    widest = std::max(widest, (x[at(s.vertex)] - (1 - s.place) * x[at(s.edge[0])] - s.place * x[at(s.edge[1])]).norm());
  const double preroll = setup.preroll_frames / setup.fps;
  return fmt::format(", open by up to {:.3g} mm, closed {:.3g} s after the start", 1e3 * widest,
                     garment.sewing_time > 0 ? garment.sewing_time : 0.5 * preroll);
}

/// "map of thickness: 0.001 to 0.004 m, mean 0.0021 m".
std::string map_text(const NamedMap& map, std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const MapKind* kind = find_map_kind(map.name);
  std::string unit;
  if (kind && kind->unit != "1") unit.append(1, ' ').append(kind->unit);
  return fmt::format("map of {}: {:.4g} to {:.4g}{}, mean {:.4g}{}", map.name, *lowest, *highest, unit,
                     sum / static_cast<double>(values.size()), unit);
}

}  // namespace

std::string sewing_text(const Mesh& mesh) {
  int seams = 0;
  for (const Stitch& s : mesh.stitches) seams = std::max(seams, s.seam + 1);
  return fmt::format("sewn: {} stitches in {} seams", mesh.stitches.size(), seams);
}

std::string size_text(std::uint64_t bytes) {
  const double b = static_cast<double>(bytes);
  if (b < 1e3) return fmt::format("{} bytes", bytes);
  if (b < 1e6) return fmt::format("{:.1f} kB", b / 1e3);
  if (b < 1e9) return fmt::format("{:.1f} MB", b / 1e6);
  return fmt::format("{:.1f} GB", b / 1e9);
}

std::vector<std::string> character_lines(const CharacterInfo& info) {
  std::vector<std::string> out;
  out.push_back(fmt::format("  {}: {} vertices, {} triangles, {} bones, {} morph targets", info.format,
                            info.vertex_count, info.triangle_count, info.bone_count, info.morph_count));
  out.push_back(fmt::format("  bind pose {}, from y = {:.4g} to {:.4g} m; {:.6g} m per file unit, up {}",
                            box_text(info.bind_bounds), info.bind_bounds.lo.y(), info.bind_bounds.hi.y(),
                            info.unit_scale, info.up.empty() ? "y" : info.up));
  for (const ClipInfo& clip : info.clips)
    out.push_back(fmt::format("  clip \"{}\": {:.4g} s from {:.4g} s, {} channels{}", clip.name, clip.duration,
                              clip.start, clip.channel_count, clip.duration > 0 ? "" : ", a still"));
  if (info.clips.empty()) out.push_back("  no clips");
  for (const std::string& name : info.mesh_names) out.push_back("  mesh \"" + name + "\"");
  for (const SurfacePart& part : info.parts)
    out.push_back(fmt::format("  part \"{}\": {:.3g} litres{}", part.name, 1e3 * part.size,
                              part.parent < 0 ? "" : ", on \"" + info.parts[at(part.parent)].name + "\""));
  return out;
}

namespace {

const std::string& wearer_of(const BakePlan& plan, const GroupPlan& group, const ClothGarment& garment) {
  const auto index = at(&garment - group.setup.garments.data());
  return plan.primaries[group.outputs[index].primary].name;
}

/// The primaries that a cloth meets, and the cloths that it is solved with.
std::string met_text(const BakePlan& plan, const GroupPlan& group, const ClothGarment& garment) {
  std::vector<std::string> names, cloths;
  for (std::size_t m = 0; m < group.bodies.size(); ++m) {
    std::size_t left_out = 0;
    const int first = group.joint->first_part(m), end = group.joint->first_part(m + 1);
    for (const int part : garment.ignores) left_out += part >= first && part < end;
    if (left_out < at(end - first)) names.push_back(in_quotes(plan.primaries[group.bodies[m]].name));
  }
  if (group.bodies.empty()) names.push_back("\"" + plan.primaries[group.primary].name + "\" alone");
  for (const ClothGarment& other : group.setup.garments)
    if (&other != &garment) cloths.push_back(in_quotes(other.name));
  return joined(names) + (cloths.empty() ? "" : "; together with cloth " + joined(cloths));
}

}  // namespace

std::vector<std::string> plan_lines(const BakePlan& plan, const std::filesystem::path& folder) {
  const Shot& shot = plan.shot();
  std::vector<std::string> out;
  out.push_back(fmt::format("{}: frames {}-{} at {:g} fps ({:.4g} s), {} frames of pre-roll{}",
                            shot.file.filename().string(), shot.first_frame, shot.last_frame, shot.fps,
                            (shot.last_frame - shot.first_frame) / shot.fps, shot.preroll,
                            shot.write_preroll ? ", written" : ""));
  for (std::size_t p = 0; p < plan.primaries.size(); ++p) {
    const PrimaryPlan& primary = plan.primaries[p];
    const PrimarySpec& spec = shot.primaries[p];
    out.push_back(fmt::format("primary \"{}\": {}{}, {:.3g} m tall, {} parts, {}", primary.name,
                              spec.shape.empty() ? spec.file.filename().string() : spec.shape,
                              spec.clip.empty() ? std::string() : ", clip \"" + spec.clip + "\"",
                              primary.info.bind_bounds.size().y(), primary.trajectory->surface().parts.size(),
                              primary.mass.text()));
    for (const std::string& line : character_lines(primary.info)) out.push_back(line);
  }
  for (const GroupPlan& group : plan.groups)
    for (const ClothGarment& garment : group.setup.garments) {
      std::size_t pinned = 0;
      for (const ClothPin& pin : garment.pins) pinned += pin.to < 0 ? pin.vertices.size() : 0;
      out.push_back(fmt::format("cloth \"{}\" on \"{}\": {} vertices, {} faces, {} pinned, {}, {} at {:g} kg/m2",
                                garment.name, wearer_of(plan, group, garment), garment.mesh.vertex_count(),
                                garment.mesh.face_count(), pinned, box_text(bounds(garment.mesh.positions)),
                                garment.fabric.name, garment.fabric.mass_per_area));
      if (plan.primaries.size() > 1) out.push_back("  meets " + met_text(plan, group, garment));
      for (const NamedMap& map : k_vertex_maps)
        if (!(garment.maps.*map.values).empty()) out.push_back("  " + map_text(map, garment.maps.*map.values));
      for (const ClothPin& pin : garment.pins)
        if (pin.to >= 0) out.push_back("  " + attachment_text(group.setup.garments, garment, pin));
      if (!garment.mesh.stitches.empty())
        out.push_back("  " + sewing_text(garment.mesh) + seam_text(garment, group.setup));
      if (garment.pattern_scale > 0)
        out.push_back(fmt::format("  cut from its pattern at {:g} m per unit of vt", garment.pattern_scale));
    }
  for (const GroupPlan& group : plan.groups) {
    if (!group.lockstep) continue;
    for (const CordSystem& c : group.lockstep->cords)
      out.push_back(fmt::format("cords \"{}\" on \"{}\": {} points, {} cords, {} held, {:g} kg, EA = {:g} N{}", c.name,
                                plan.primaries[group.primary].name, c.graph.points.size(), c.graph.cords.size(),
                                c.graph.held.size(), c.mass, c.stretch,
                                group.lockstep->prop->two_way ? ", two-way" : ""));
  }
  for (const std::string& note : plan.notes) out.push_back("note: " + note);
  std::string formats;
  for (const std::string& f : shot.cache_formats) formats += (formats.empty() ? "" : ", ") + f;
  out.push_back(fmt::format("caches: {} frames as {}, about {}, in {}", plan.written_count(), formats,
                            size_text(cache_bytes(plan)), folder.string()));
  return out;
}

}  // namespace ft

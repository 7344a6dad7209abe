#include "baker/plan_text.h"

#include <fmt/format.h>

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
    out.push_back(fmt::format("  clip \"{}\": {:.4g} s from {:.4g} s, {} channels", clip.name, clip.duration,
                              clip.start, clip.channel_count));
  if (info.clips.empty()) out.push_back("  no clips");
  for (const std::string& name : info.mesh_names) out.push_back("  mesh \"" + name + "\"");
  return out;
}

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
                                garment.name, plan.primaries[group.primary].name, garment.mesh.vertex_count(),
                                garment.mesh.face_count(), pinned, box_text(bounds(garment.mesh.positions)),
                                garment.fabric.name, garment.fabric.mass_per_area));
      for (const ClothPin& pin : garment.pins)
        if (pin.to >= 0) out.push_back("  " + attachment_text(group.setup.garments, garment, pin));
      if (!garment.mesh.stitches.empty())
        out.push_back("  " + sewing_text(garment.mesh) + (garment.pattern_scale > 0 ? ", cut from its pattern" : ""));
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

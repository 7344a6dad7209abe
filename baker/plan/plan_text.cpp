#include "baker/plan/plan_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/plan/air.h"
#include "baker/plan/output_formats.h"

namespace ft::inline baker {
namespace {

std::uint64_t cache_bytes(const BakePlan& plan) {
  std::uint64_t sum = 0;
  const auto frames = static_cast<std::uint64_t>(plan.written_count());
  for (const BakePlan& later : plan.later) sum += cache_bytes(later);
  for (const auto& group : plan.groups) {
    for (const SystemOutput& output : group->outputs)
      for (const CacheFormat* format : formats_for(plan.shot(), output.content()))
        sum += frames * format->bytes_per_frame(output.content(), output.counts());
    // Body as drawn, and the collider: about as many vertices again before refinement.
    if (plan.shot().cache_collider)
      sum += 2 * 12 * frames *
             static_cast<std::uint64_t>(plan.primaries[group->primary].trajectory->surface().vertex_count());
  }
  return sum;
}

}  // namespace

std::string sewing_text(const Mesh& mesh) {
  int seams = 0;
  for (const Stitch& s : mesh.stitches) seams = std::max(seams, s.seam + 1);
  return fmt::format("sewn: {} stitches in {} seams", mesh.stitches.size(), seams);
}

std::string box_text(const Box& box) {
  const Vec3 size = box.size();
  return fmt::format("{:.4g} x {:.4g} x {:.4g} m", size.x(), size.y(), size.z());
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
  for (const CharacterContent& content : info.contents)
    out.push_back(fmt::format("  {} {}: {}", content.count, content.what, content.use));
  for (const SurfacePart& part : info.parts)
    out.push_back(fmt::format("  part \"{}\": {:.3g} litres{}", part.name, 1e3 * part.size,
                              part.parent < 0 ? "" : ", on \"" + info.parts[at(part.parent)].name + "\""));
  return out;
}

std::string stage_line(const BakePlan& plan) {
  std::string out = fmt::format("stage {} of {}: ", plan.stage + 1, plan.stage_count);
  bool first = true;
  for (const auto& group : plan.groups)
    for (const SystemOutput& output : group->outputs) {
      out += fmt::format("{}{} \"{}\" on \"{}\"", first ? "" : ", ", group->role(), output.name(),
                         plan.primaries[output.primary].name);
      first = false;
    }
  return out;
}

std::vector<std::string> plan_lines(const BakePlan& plan, const std::filesystem::path& folder) {
  const Shot& shot = plan.shot();
  std::vector<std::string> out;
  out.push_back(fmt::format("{}: frames {}-{} at {:g} fps ({:.4g} s), {} frames of pre-roll{}",
                            shot.file.filename().string(), shot.first_frame, shot.last_frame, shot.fps,
                            (shot.last_frame - shot.first_frame) / shot.fps, shot.preroll,
                            shot.write_preroll ? ", written" : ""));
  for (std::size_t p = 0; p < shot.primaries.size(); ++p) {
    const PrimaryPlan& primary = plan.primaries[p];
    const PrimarySpec& spec = shot.primaries[p];
    out.push_back(fmt::format("primary \"{}\": {}{}, {:.3g} m tall, {} parts, {}", primary.name,
                              spec.shape.empty() ? spec.file.filename().string() : spec.shape,
                              spec.clip.empty() ? std::string() : ", clip \"" + spec.clip + "\"",
                              primary.info.bind_bounds.size().y(), primary.trajectory->surface().parts.size(),
                              primary.mass.text()));
    for (const std::string& line : character_lines(primary.info)) out.push_back(line);
  }
  std::vector<std::string> notes;
  const auto add_stage = [&](const BakePlan& stage) {
    if (stage.stage_count > 1) out.push_back(stage_line(stage));
    for (const auto& group : stage.groups)
      for (std::string& line : group->lines(stage)) out.push_back(std::move(line));
    for (const std::string& note : stage.notes)
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  };
  for (std::string& line : wind_lines(shot, *plan.wind)) out.push_back(std::move(line));
  add_stage(plan);
  for (const BakePlan& later : plan.later) add_stage(later);
  if (!plan.later.empty())
    out.push_back("how a body that is baked in an earlier stage moves is not known yet: here it stands as it starts");
  for (const std::string& note : notes) out.push_back("note: " + note);
  std::string formats;
  for (const std::string& f : shot.cache_formats) formats += (formats.empty() ? "" : ", ") + f;
  out.push_back(fmt::format("caches: {} frames as {}, about {}, in {}", plan.written_count(), formats,
                            size_text(cache_bytes(plan)), folder.string()));
  if (shot.cache_volumes) out.push_back("volumes: the water as OpenVDB, a file for each frame, when all is baked");
  return out;
}

}  // namespace ft::inline baker

// `info FILE`: what is in a character, a garment mesh, a shot, a cache or a bake folder. By content where the format
// allows it: folders, shots and OBJ by name; caches by their magic; everything else is tried as a character.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "baker/commands/command_line.h"
#include "baker/plan/inputs.h"
#include "baker/plan/plan.h"
#include "baker/plan/plan_text.h"
#include "baker/plan/room_report.h"
#include "baker/record/manifest.h"
#include "io/cache/cache.h"
#include "io/import/import.h"
#include "io/shot/garment_size.h"
#include "io/shot/mesh_file.h"
#include "io/shot/shot.h"

namespace ft::inline baker {
namespace {

using Lines = std::vector<std::string>;

std::string size_of(const Box& box) {
  const Vec3 size = box.size();
  return box.empty() ? "empty"
                     : fmt::format("{:.4g} x {:.4g} x {:.4g} m, from ({:.4g}, {:.4g}, {:.4g})", size.x(), size.y(),
                                   size.z(), box.lo.x(), box.lo.y(), box.lo.z());
}

/// What a system of a bake has, of the shape that it is of.
std::string contents(const ManifestSystem& s) {
  switch (s.shape) {
    case OutputShape::k_mesh: return fmt::format("{} vertices, {} faces", s.vertex_count, s.face_count);
    case OutputShape::k_curves: return fmt::format("{} strands, {} vertices", s.curve_count, s.count);
    case OutputShape::k_points: return "points, which come and go";
    default: return fmt::format("{} {}, {} prototypes", s.count, shape_key(s.shape), s.prototypes.size());
  }
}

/// "16 to 32 vertices each, widths 0.1 to 0.4 mm, with ids"
std::string curve_text(const CurveSet& set) {
  if (set.vertices_per_curve.empty()) return "no strands";
  const auto [fewest, most] = std::minmax_element(set.vertices_per_curve.begin(), set.vertices_per_curve.end());
  std::string out = fmt::format("{} strands of ", set.curve_count());
  out += *fewest == *most ? fmt::format("{} vertices", *most) : fmt::format("{} to {} vertices", *fewest, *most);
  if (set.widths.empty()) {
    out += ", without widths";
  } else {
    const auto [least, widest] = std::minmax_element(set.widths.begin(), set.widths.end());
    out += *least == *widest ? fmt::format(", {:.3g} mm wide", 1000 * *widest)
                             : fmt::format(", {:.3g} to {:.3g} mm wide", 1000 * *least, 1000 * *widest);
  }
  return out + (set.ids.empty() ? ", without ids" : ", with ids");
}

Result<Lines> folder_info(const std::filesystem::path& path) {
  auto manifest = read_manifest(path);
  if (!manifest) return manifest.error();
  const Manifest& m = *manifest;
  Lines out;
  out.push_back(
      fmt::format("bake of {}, followthrough {}, {}", m.shot, m.version, m.complete ? "complete" : "not finished"));
  out.push_back(fmt::format("  frames {}-{} at {:g} fps, {} frames of pre-roll, caches from {}", m.first_frame,
                            m.last_frame, m.fps, m.preroll, m.first_written));
  for (const ManifestInput& i : m.inputs) out.push_back(fmt::format("  input {}: {}", i.role, i.name));
  for (const ManifestSystem& s : m.systems) {
    std::string files;
    for (const ManifestCache& c : s.caches)
      files += " " + c.file + (c.bytes > 0 ? " (" + size_text(c.bytes) + ")" : "");
    out.push_back(fmt::format("  {} \"{}\": {}:{}", s.role, s.name, contents(s), files));
  }
  int crossings = 0, incidents = 0;
  double deepest = 0, strain = 0;
  for (const FrameReport& f : m.frames) {
    incidents += static_cast<int>(f.incidents.size());
    if (f.frame < m.first_written) continue;
    crossings += f.crossings_body + f.crossings_self;
    deepest = std::max(deepest, f.deepest_drawn);
    strain = std::max(strain, f.strain_p99);
  }
  out.push_back(fmt::format(
      "  certificate: {} crossings, deepest in the drawn body {:.2f} mm, worst p99 strain {:.2f} %, {} incidents",
      crossings, 1e3 * deepest, 100 * strain, incidents));
  for (const std::string& note : m.notes) out.push_back("  note: " + note);
  return out;
}

/// What the clips hold that a bake would stumble over: jumps, places without room. Imports the characters.
Result<Lines> scan_lines(const std::filesystem::path& path) {
  ShotFaults faults;
  auto inputs = read_inputs(path, {}, std::nullopt, faults);
  if (!inputs) return inputs.error();
  auto plan = make_plan(std::move(*inputs), import_primary, {});
  if (!plan) return plan.error();
  const RoomReport room = find_room(*plan);
  Lines out;
  for (const std::string& note : plan->notes) out.push_back("note: " + note);
  for (std::string& line : room_lines(room, room.places.size())) out.push_back(std::move(line));
  out.push_back(fmt::format("looked at {} frames in {:.2f} s", room.frame_count, room.seconds));
  return out;
}

Result<Lines> shot_info(const std::filesystem::path& path, bool scan) {
  ShotFaults faults;
  auto shot = read_shot(path, shot_vocabulary(), {}, faults);
  if (!shot) {
    for (std::size_t i = 1; i < faults.messages.size(); ++i) complain(faults.messages[i]);
    return shot.error();
  }
  Lines out{fmt::format("shot: frames {}-{} at {:g} fps, {} primaries, {} secondaries", shot->first_frame,
                        shot->last_frame, shot->fps, shot->primaries.size(), shot->secondaries.size())};
  for (const auto& [key, value] : settings(*shot)) out.push_back("  " + key + " = " + value);
  if (!scan) return out;
  auto found = scan_lines(path);
  if (!found) return found.error();
  for (std::string& line : *found) out.push_back("  " + line);
  return out;
}

Result<Lines> mesh_info(const std::filesystem::path& path) {
  std::vector<std::string> notes;
  auto mesh = read_obj(path, &notes);
  if (!mesh) return mesh.error();
  Lines out{fmt::format("mesh: {} vertices, {} faces, {} pattern coordinates", mesh->vertex_count(), mesh->face_count(),
                        mesh->uvs.size())};
  out.push_back("  size " + size_of(bounds(mesh->positions)) + " if the file is in metres");
  for (const VertexGroup& group : mesh->groups)
    out.push_back(fmt::format("  group \"{}\": {} vertices", group.name, group.vertices.size()));
  if (!mesh->stitches.empty()) out.push_back(fmt::format("  {} panels, {}", panel_count(*mesh), sewing_text(*mesh)));
  for (const std::string& note : notes) out.push_back("  note: " + note);
  const Status garment = check_garment(*mesh);
  const std::string doubt = doubt_of_size(bounds(mesh->positions).size().maxCoeff(), 1);
  out.push_back(!garment        ? "  as a garment: " + garment.error().what
                : doubt.empty() ? "  as a garment: good"
                                : "  as a garment: good but for its size");
  if (!doubt.empty()) out.push_back("  note: the mesh " + doubt);
  return out;
}

Lines cache_info(CacheReader& reader) {
  const CacheInfo& info = reader.info();
  const bool mesh = info.content.shape == OutputShape::k_mesh;
  const bool curves = info.content.shape == OutputShape::k_curves;
  const std::string_view elements = mesh || curves ? std::string_view("vertices") : shape_key(info.content.shape);
  Lines out{fmt::format("cache of \"{}\": {} frames from {}{}, {} {}{}", info.system, info.frame_count,
                        info.first_frame, info.has_fps ? fmt::format(" at {:g} fps", info.fps) : std::string(),
                        mesh ? info.mesh.vertex_count() : info.vertex_count, elements,
                        info.content.changes ? " in the first frame" : "")};
  std::string what = info.has_topology ? fmt::format("{} faces", info.mesh.face_count()) : "points only";
  if (info.content.shape == OutputShape::k_instances)
    what = fmt::format("{} prototypes", info.instances.prototype_names.size());
  else if (curves)
    what = curve_text(info.curves);
  else if (info.content.shape != OutputShape::k_mesh)
    what = std::string(shape_name(info.content.shape));
  out.push_back(fmt::format("  {}, {}", what, info.has_velocity ? "with velocities" : "without velocities"));
  Box box;
  std::vector<Vec3f> x;
  for (int i = 0; i < info.frame_count; ++i) {
    if (const Status read = reader.read_frame(i, x); !read) {
      out.push_back("  frame " + std::to_string(info.first_frame + i) + " cannot be read: " + read.error().text());
      break;
    }
    for (const Vec3f& p : x) box.include(p.cast<double>());
  }
  out.push_back("  bounds over all frames " + size_of(box));
  for (const auto& [key, value] : info.metadata) out.push_back("  " + key + ": " + value);
  return out;
}

Result<Lines> file_info(const std::filesystem::path& path, bool scan) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return input_error("does not exist", path.string());
  if (std::filesystem::is_directory(path, error)) return folder_info(path);
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".toml") return shot_info(path, scan);
  if (extension == ".obj") return mesh_info(path);
  for (const CacheFormat& format : cache_formats())
    if (extension == format.extension) {
      auto cache = open_cache_of_any_shape(path);
      if (!cache) return cache.error();
      return cache_info(**cache);
    }
  auto character = inspect_character(path);
  if (!character) return character.error();
  Lines out{"character"};
  for (std::string& line : character_lines(*character)) out.push_back(std::move(line));
  for (const std::string& note : character->notes) out.push_back("  note: " + note);
  return out;
}

struct InfoArguments {
  std::filesystem::path file;
  bool shot_keys = false, scan = false;
};

int run(const InfoArguments& a) {
  if (a.shot_keys) {
    std::printf("%s", shot_file_reference(shot_vocabulary()).c_str());
    if (a.file.empty()) return 0;
  }
  if (a.file.empty()) {
    complain("info needs a file (or --shot-keys)");
    return exit_code(ErrorKind::k_usage);
  }
  auto lines = file_info(a.file, a.scan);
  if (!lines) {
    complain(lines.error().text());
    return exit_code(lines.error().kind);
  }
  for (const std::string& line : *lines) std::printf("%s\n", line.c_str());
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, int& exit_code) {
  auto* command = app.add_subcommand("info", "Says what is in a character, mesh, shot, cache or bake folder");
  auto a = std::make_shared<InfoArguments>();
  command->add_option("file", a->file, "The file or folder")->type_name("FILE");
  command->add_flag("--shot-keys", a->shot_keys, "Print the keys of a shot file as Markdown");
  command->add_flag("--scan", a->scan,
                    "Of a shot: look at every frame of its characters for jumps and for places without room");
  command->callback([a, &exit_code] { exit_code = run(*a); });
}

}  // namespace ft::inline baker

// import_primary(): file -> clip -> place -> surface -> Trajectory. Reads like the list of decisions that an import
// takes; each is a function of the files beside this one, and each thing that was repaired or guessed becomes a note.
#include "io/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/import/body/figure.h"
#include "io/import/character/clips.h"
#include "io/import/files/read_geometry_cache.h"
#include "io/import/import_cache.h"
#include "io/import/motion/character_trajectory.h"
#include "io/import/motion/figure_bind.h"
#include "io/import/motion/placed_character.h"
#include "io/import/motion/placement.h"
#include "io/import/motion/sampled_trajectory.h"
#include "io/import/motion/sheet.h"
#include "io/import/motion/size_guard.h"
#include "io/import/repair/facing.h"
#include "io/import/repair/stray_vertices.h"

namespace ft::inline io {
namespace {

bool wanted(const CharacterMesh& mesh, const Character& character, const std::vector<std::string>& names,
            std::vector<char>& seen) {
  if (names.empty()) return true;
  bool found = false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (mesh.name == names[i] || character.nodes[static_cast<std::size_t>(mesh.node)].name == names[i])
      seen[i] = 1, found = true;
  return found;
}

std::vector<std::string> mesh_names(const Character& character) {
  std::vector<std::string> out;
  for (const CharacterMesh& mesh : character.meshes) {
    const std::string& node = character.nodes[static_cast<std::size_t>(mesh.node)].name;
    const std::string& name = node.empty() ? mesh.name : node;
    if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
  }
  return out;
}

/// Indices of the meshes that make the collider.
Result<std::vector<int>> choose_meshes(const Character& character, const std::vector<std::string>& names,
                                       const std::string& file) {
  std::vector<int> out;
  std::vector<char> seen(names.size(), 0);
  for (std::size_t m = 0; m < character.meshes.size(); ++m)
    if (!character.meshes[m].triangles.empty() && wanted(character.meshes[m], character, names, seen))
      out.push_back(static_cast<int>(m));
  const auto existing = mesh_names(character);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (seen[i]) continue;
    std::string hint;
    for (const std::string& name : existing) hint += (hint.empty() ? "there are: " : ", ") + name;
    if (const std::string guess = nearest_name(names[i], existing); !guess.empty())
      hint = "did you mean \"" + guess + "\"? " + hint;
    return usage_error("mesh \"" + names[i] + "\" does not exist", file, hint);
  }
  if (out.empty())
    return input_error("has no mesh with triangles", file,
                       "if it holds only the animation, give the character as file = and this as animation =");
  return out;
}

void describe(const Character& character, const std::vector<int>& meshes, CharacterInfo& info) {
  info.format = character.format;
  info.node_count = static_cast<int>(character.nodes.size());
  std::vector<char> is_bone(character.nodes.size(), 0);
  for (const int m : meshes) {
    const CharacterMesh& mesh = character.meshes[static_cast<std::size_t>(m)];
    info.vertex_count += static_cast<int>(mesh.positions.size());
    info.triangle_count += static_cast<int>(mesh.triangles.size());
    info.morph_count += static_cast<int>(mesh.morphs.size());
    for (const SkinBone& bone : mesh.bones) is_bone[static_cast<std::size_t>(bone.node)] = 1;
  }
  info.bone_count = static_cast<int>(std::count(is_bone.begin(), is_bone.end(), 1));
  for (const Clip& clip : character.clips)
    info.clips.push_back({clip.name, clip.start, clip.duration(), clip.moved_count()});
  info.mesh_names = mesh_names(character);
  info.notes.insert(info.notes.begin(), character.notes.begin(), character.notes.end());
}

/// Its faces then point outwards in the pose of its first sample; linear: file units to metres.
void turn_cache_outwards(GeometryCache& cache, const Mat3& linear, std::vector<std::string>& notes) {
  std::vector<Vec3> positions;
  for (const Vec3f& p : cache.sample(0)) positions.push_back(linear * p.cast<double>());
  std::vector<Triangle> triangles = triangulate(cache.mesh);
  const FacingReport facing = turn_outwards(positions, triangles);
  if (facing.turned_count == 0) return;
  notes.push_back(facing.text());
  cache.mesh = make_triangle_mesh(cache.mesh.name, std::move(cache.mesh.positions), triangles);
}

/// Whether it is one in its first sample, if the request says nothing of it.
bool is_sheet(const GeometryCache& cache, const Mat3& linear, const std::string& surface,
              std::vector<std::string>& notes) {
  if (!surface.empty()) return surface == "sheet";
  std::vector<Vec3> positions;
  for (const Vec3f& p : cache.sample(0)) positions.push_back(linear * p.cast<double>());
  const Openings openings = openings_of(positions, triangulate(cache.mesh));
  const bool out = openings.share() >= k_sheet_share;
  if (std::string note = openings_note(openings, out); !note.empty()) notes.push_back(std::move(note));
  return out;
}

/// Whether a geometry cache says when its samples are.
bool knows_its_rate(const std::filesystem::path& file) {
  return file.extension() == ".mdd" || file.extension() == ".abc";
}

Result<ImportedPrimary> import_geometry_cache(const ImportRequest& request) {
  const double fps = request.source_fps > 0 ? request.source_fps : knows_its_rate(request.file) ? 0 : request.shot_fps;
  auto cache = read_geometry_cache(request.file, request.topology, fps);
  if (!cache) return cache.error();
  const std::string name = request.file.string();
  auto axes = axes_from_up(request.up.empty() ? "y" : request.up);
  if (!axes) return axes.error();
  Placement placement;
  placement.unit_given = request.unit_scale > 0;
  placement.unit_scale = placement.unit_given ? request.unit_scale : 1;
  placement.axes = *axes, placement.up = request.up.empty() ? "y" : request.up;

  Box box;
  for (const Vec3f& p : cache->sample(0)) box.include(Vec3(placement.unit_scale * placement.axes * p.cast<double>()));
  const double measured = box.size().y();
  if (request.height > 0 && measured > 0) {
    const double factor = request.height / measured;
    placement.unit_scale *= factor;
    box.lo *= factor, box.hi *= factor;
  } else if (!placement.unit_given && cache->times.size() > 1) {  // a prop may have any size
    if (Status s = check_height(measured, placement, name); !s) return s.error();
  }
  const Mat3 linear = placement.unit_scale * placement.axes;
  const Clip whole{.name = cache->format, .start = 0, .end = cache->times.back()};
  if (Status s = check_clip_range(whole, request.clip_start, request.duration, request.speed, request.shot_fps, name);
      !s)
    return s.error();

  ImportedPrimary out;
  out.content = cache->content;
  out.info.notes = cache->notes;
  turn_cache_outwards(*cache, linear, out.info.notes);
  out.info.format = cache->format;
  out.info.vertex_count = cache->vertex_count;
  out.info.unit_scale = placement.unit_scale, out.info.up = placement.up;
  out.info.bind_bounds = box;
  out.info.clips.push_back({"samples", 0, cache->times.back(), static_cast<int>(cache->times.size())});
  out.info.mesh_names.push_back(cache->mesh.name);
  if (cache->times.size() == 1 && request.duration > 0) {
    out.info.still = true;
    out.info.notes.push_back(cache->format == "OBJ" ? "is one OBJ and no numbered sequence: it stands still"
                                                    : "holds one sample: it stands still");
  }
  const auto frame_of = [&](int sample) {
    const double time = cache->times[static_cast<std::size_t>(sample)] - request.clip_start;
    return request.first_frame + std::round(100 * time / request.speed * request.shot_fps) / 100;
  };
  for (std::string& note : stray_notes(cache->strays, request.file.filename().string(), placement.unit_scale, frame_of))
    out.info.notes.push_back(std::move(note));
  const bool sheet = is_sheet(*cache, linear, request.surface, out.info.notes);
  out.trajectory = std::make_unique<SampledTrajectory>(
      std::move(*cache), placement.axes, placement.unit_scale,
      Playback{request.clip_start, request.speed, request.preroll, request.clip_bind}, sheet);
  out.info.triangle_count = static_cast<int>(out.trajectory->surface().triangles.size());
  return out;
}

SizedBody sized(const Character& character) {
  return {character.format == "BVH", find_figure(character).missing().empty()};
}

/// The character with the clips that may play: its own, or those of the animation file.
Result<LoadedCharacter> load_with_animation(const ImportRequest& request, std::vector<std::string>& notes) {
  auto loaded = load_character(request.file, request.cache_folder, request.limits);
  if (!loaded || request.animation.empty()) return loaded;
  auto motion = load_character(request.animation, request.cache_folder, request.limits);
  if (!motion) return motion.error();
  auto clips = retarget_clips(motion->character, loaded->character, request.animation.string(), notes);
  if (!clips) return clips.error();
  loaded->character.clips = std::move(*clips);
  loaded->content = Hasher()
                        .number(loaded->content.low)
                        .number(loaded->content.high)
                        .number(motion->content.low)
                        .number(motion->content.high)
                        .digest();
  return loaded;
}

Status check_request(const ImportRequest& request) {
  const std::string name = request.file.string();
  if (!request.bind.empty() && request.bind != "t_pose")
    return usage_error("bind = \"" + request.bind + "\" is unknown", name, "\"t_pose\"");
  if (!request.bind.empty() && is_geometry_cache(request.file))
    return usage_error("bind = \"t_pose\" needs a skeleton, and a geometry cache has none", name);
  if (request.body != "blended" && request.body != "capsules")
    return usage_error("body = \"" + request.body + "\" is unknown", name, "\"blended\" or \"capsules\"");
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  if (!positive(request.speed) || !positive(request.shot_fps))
    return usage_error("speed and fps have to be above 0", name);
  if (!(request.height >= 0) || !std::isfinite(request.clip_start) || !(request.preroll >= 0) ||
      !(request.duration >= 0))
    return usage_error("height, preroll and duration cannot be below 0", name);
  return {};
}

}  // namespace

Result<PlacedCharacter> place_character(const ImportRequest& request) {
  if (Status s = check_request(request); !s) return s.error();
  const std::string name = request.file.string();
  const std::string clip_file = request.animation.empty() ? name : request.animation.string();
  PlacedCharacter out;
  std::vector<std::string>& notes = out.info.notes;
  auto loaded = load_with_animation(request, notes);
  if (!loaded) return loaded.error();
  Character& character = out.character = std::move(loaded->character);
  out.content = loaded->content;

  auto clip_index = select_clip(character, request.clip, clip_file, notes);
  if (!clip_index) return clip_index.error();
  const Clip* clip = *clip_index < 0 ? nullptr : &character.clips[static_cast<std::size_t>(*clip_index)];
  BindPose bind;
  auto placement = place_bind_pose(character, clip, request, bind, notes);
  if (!placement) return placement.error();
  auto meshes = choose_meshes(character, request.meshes, name);
  if (!meshes) return meshes.error();
  Skin& skin = out.skin = weld(character, *meshes, notes);
  if (skin.surface.triangles.empty()) return input_error("has no triangle with an area", name);

  const ClipPose rest(character, nullptr);
  std::vector<Vec3> positions(skin.base.size());
  deform(skin, placement->matrix(), bind.globals, rest.rest_morphs(), positions);
  if (!all_finite(positions)) return input_error("its bind pose is not finite", name);
  if (const FacingReport facing = turn_outwards(positions, skin.surface.triangles); facing.turned_count > 0)
    notes.push_back(facing.text());
  const double measured = bounds(positions).size().y();
  if (request.height > 0 && measured > 0) {
    placement->unit_scale *= request.height / measured;
    for (Vec3& p : positions) p *= request.height / measured;
  } else if (!placement->unit_given) {
    if (Status s = check_height(measured, *placement, name); !s) return s.error();
  }
  if (Status s = check_shape(bounds(positions), sized(character), name, notes); !s) return s.error();
  if (clip != nullptr)
    if (Status s =
            check_clip_range(*clip, request.clip_start, request.duration, request.speed, request.shot_fps, clip_file);
        !s)
      return s.error();
  out.info.still = clip == nullptr || clip->duration() <= 0;
  if (clip != nullptr && out.info.still && request.duration > 0)
    notes.push_back("clip \"" + clip->name + "\" has " + (clip->moved_count() == 0 ? "no keys" : "one key only") +
                    ": the character stands still");
  assign_parts(character, positions, skin);
  if (bind.from_inverse_binds)
    notes.emplace_back("the nodes do not rest in the bind pose; it was taken from the inverse bind matrices");

  describe(character, *meshes, out.info);
  out.info.unit_scale = placement->unit_scale, out.info.up = placement->up;
  out.info.bind_bounds = bounds(positions);
  out.clip = *clip_index;
  out.pelvis = find_pelvis(character, *meshes);
  out.placement = placement->matrix();
  out.bind = std::move(bind);
  out.playback = {(clip != nullptr ? clip->start : 0) + request.clip_start, request.speed, request.preroll, {}};
  return out;
}

Result<ImportedPrimary> play(PlacedCharacter placed, const ImportRequest& request) {
  ImportedPrimary out;
  out.info = std::move(placed.info);
  out.content = placed.content;
  const SizedBody body = sized(placed.character);
  const auto kept = std::make_shared<const Character>(std::move(placed.character));
  const Clip* clip = placed.clip < 0 ? nullptr : &kept->clips[at(placed.clip)];
  out.trajectory = std::make_unique<CharacterTrajectory>(kept, clip, std::move(placed.skin), std::move(placed.bind),
                                                         placed.pelvis, placed.placement, placed.playback);

  // Numbers that are finite one by one can still be far out together.
  std::vector<Vec3> positions(at(out.trajectory->surface().vertex_count()));
  for (const double t : {-request.preroll, 0.0, request.duration}) {
    out.trajectory->sample(t, positions);
    if (!all_finite(positions) || bounds(positions).size().norm() > 1e6)
      return input_error(
          "the character is not finite, or larger than 1000 km, " + std::to_string(t) + " s into the shot",
          (request.animation.empty() ? request.file : request.animation).string());
  }
  if (Status s = check_growth(*out.trajectory, request, body, out.info.notes); !s) return s.error();
  return out;
}

Result<ImportedPrimary> import_primary(const ImportRequest& request) {
  if (Status s = check_request(request); !s) return s.error();
  if (is_geometry_cache(request.file)) return import_geometry_cache(request);
  auto placed = place_character(request);
  if (!placed) return placed.error();
  std::shared_ptr<const PlacedCharacter> kept;
  if (request.keep_character) kept = std::make_shared<const PlacedCharacter>(*placed);
  auto out = play(std::move(*placed), request);
  if (out) out->character = std::move(kept);
  return out;
}

Result<CharacterInfo> inspect_character(const std::filesystem::path& file, const ImportLimits& limits) {
  CharacterInfo info;
  if (is_geometry_cache(file)) {
    auto cache = read_geometry_cache(file, {}, 0, false);
    if (!cache) return cache.error();
    info.format = cache->format, info.up = "y";
    info.vertex_count = cache->vertex_count;
    info.triangle_count = static_cast<int>(triangulate(cache->mesh).size());
    for (const Vec3f& p : cache->sample(0)) info.bind_bounds.include(Vec3(p.cast<double>()));
    info.clips.push_back({"samples", 0, cache->times.back(), static_cast<int>(cache->times.size())});
    info.notes = cache->notes;
    return info;
  }
  auto loaded = load_character(file, {}, limits);
  if (!loaded) return loaded.error();
  const Character& character = loaded->character;
  const BindPose bind = find_bind_pose(character);
  auto placement = find_placement(character, 0, "", bind.globals, info.notes);
  if (!placement) return placement.error();
  std::vector<int> meshes;
  for (std::size_t m = 0; m < character.meshes.size(); ++m) meshes.push_back(static_cast<int>(m));
  describe(character, meshes, info);
  info.unit_scale = placement->unit_scale, info.up = placement->up;
  Skin skin = weld(character, meshes, info.notes);
  const ClipPose rest(character, nullptr);
  std::vector<Vec3> positions(skin.base.size());
  deform(skin, placement->matrix(), bind.globals, rest.rest_morphs(), positions);
  if (const FacingReport facing = turn_outwards(positions, skin.surface.triangles); facing.turned_count > 0)
    info.notes.push_back(facing.text());
  if (!skin.surface.triangles.empty() && all_finite(positions)) {
    assign_parts(character, positions, skin);
    info.parts = skin.surface.parts;
  }
  if (positions.empty())
    for (const Mat4& m : bind.globals) positions.push_back((placement->matrix() * m).topRightCorner<3, 1>());
  info.bind_bounds = bounds(positions);
  if (meshes.empty()) info.notes.emplace_back("has no mesh: bounds are those of its skeleton");
  if (bind.from_inverse_binds)
    info.notes.emplace_back("the nodes do not rest in the bind pose; it was taken from the inverse bind matrices");
  return info;
}

}  // namespace ft::inline io

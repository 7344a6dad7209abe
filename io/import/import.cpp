// import_primary(): file -> clip -> place -> surface -> Trajectory. Reads like the list of decisions that an import
// takes; each is a function of the files beside this one, and each thing that was repaired or guessed becomes a note.
#include "io/import/import.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "io/import/body/figure.h"
#include "io/import/character/choose_meshes.h"
#include "io/import/character/clips.h"
#include "io/import/character_info.h"
#include "io/import/files/read_geometry_cache.h"
#include "io/import/import_cache.h"
#include "io/import/import_geometry_cache.h"
#include "io/import/motion/character_trajectory.h"
#include "io/import/motion/cycle.h"
#include "io/import/motion/figure_bind.h"
#include "io/import/motion/placed_character.h"
#include "io/import/motion/placement.h"
#include "io/import/motion/size_guard.h"
#include "io/import/repair/facing.h"

namespace ft::inline io {
namespace {

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
  const std::string from = request.animation.filename().string();
  for (const std::string& note : motion->character.notes) notes.push_back(from + ": " + note);
  for (CharacterContent content : motion->character.contents) {
    content.what += " of " + from;
    loaded->character.contents.push_back(std::move(content));
  }
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
  auto meshes = choose_meshes(character, request.meshes, name, notes);
  if (!meshes) return meshes.error();
  Skin& skin = out.skin = weld(character, *meshes, notes);
  if (skin.surface.triangles.empty()) return input_error("has no triangle with an area", name);

  const ClipPose rest(character, nullptr);
  std::vector<Vec3> positions(skin.base.size());
  deform(skin, placement->matrix(), bind.globals, rest.rest_morphs(), positions);
  if (!all_finite(positions)) return input_error("its bind pose is not finite", name);
  for (std::string& note : turn_outwards(positions, skin.surface.triangles).notes()) notes.push_back(std::move(note));
  const double measured = bounds(positions).size().y();
  if (request.height > 0 && measured > 0) {
    placement->unit_scale *= request.height / measured;
    for (Vec3& p : positions) p *= request.height / measured;
  } else if (!placement->unit_given) {
    if (Status s = check_height(measured, *placement, name); !s) return s.error();
  }
  if (Status s = check_shape(bounds(positions), sized(character), name, notes); !s) return s.error();
  if (clip != nullptr)
    if (Status s = check_clip_range(*clip, request, clip_file); !s) return s.error();
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
  out.playback.start = (clip != nullptr ? clip->start : 0) + request.clip_start;
  out.playback.speed = request.speed, out.playback.preroll = request.preroll;
  if (request.loop && clip != nullptr && !out.info.still)
    if (Status s = repeat_clip(out, *meshes, bounds(positions).size().maxCoeff(), request); !s) return s.error();
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

}  // namespace ft::inline io

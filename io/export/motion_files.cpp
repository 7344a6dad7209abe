#include "io/export/motion_files.h"

#include <algorithm>

#include "io/export/glb_from_character.h"
#include "io/export/gltf_export.h"
#include "io/import/character/clips.h"
#include "io/import/character/match_nodes.h"
#include "io/import/import_cache.h"

namespace ft::inline io {
namespace {

/// Changes of a character as changes of the file that its clips came from: retarget_clips() backwards.
Result<std::vector<ChangedChannel>> for_animation_file(const Character& character, const Character& file,
                                                       std::span<const ChangedChannel> changes) {
  const std::vector<int> to = match_nodes(file, character).to;
  std::vector<ChangedChannel> out(changes.begin(), changes.end());
  for (ChangedChannel& change : out) {
    const auto from = std::find(to.begin(), to.end(), change.node);
    if (from == to.end())
      return input_error("node \"" + character.nodes[at(change.node)].name + "\" is to be changed and is not in it");
    change.node = static_cast<int>(from - to.begin());
    if (change.path != ChannelPath::k_translation) continue;
    for (double& v : change.track.values) v /= unit_ratio(file, character);
  }
  return out;
}

}  // namespace

Result<MotionFiles> export_motion(const ImportRequest& request, const PlacedCharacter& placed,
                                  std::span<const ChangedChannel> changes, const BvhFrames& frames) {
  if (placed.clip < 0) return usage_error("stands still: there is no motion to export", request.file.string());
  PlacedCharacter moved = placed;
  if (Status s = apply_changes(moved.character, moved.clip, changes); !s) return s.error();

  const bool other_file = !request.animation.empty();
  const std::filesystem::path& source = other_file ? request.animation : request.file;
  Character own;
  std::vector<ChangedChannel> own_changes(changes.begin(), changes.end());
  if (other_file) {
    auto loaded = load_character(source, request.cache_folder, request.limits);
    if (!loaded) return loaded.error();
    own = std::move(loaded->character);
    auto mapped = for_animation_file(placed.character, own, changes);
    if (!mapped) return input_error(mapped.error().what, source.string());
    own_changes = std::move(*mapped);
  }
  const Character& original = other_file ? own : placed.character;

  MotionFiles out;
  // A clip that repeats has more keys than its file.
  const bool gltf = original.format == "glTF" && !placed.repeated, bvh = original.format == "BVH" && !placed.repeated;
  auto glb = gltf ? export_glb(source, original, placed.clip, own_changes)
                  : glb_from_character(moved.character, moved.clip, moved.placement, out.notes);
  if (!glb) return glb.error();
  auto text = bvh ? export_bvh(source, original, placed.clip, own_changes)
                  : bvh_from_character(moved.character, moved.clip, moved.placement, frames);
  if (!text) return text.error();
  out.glb = std::move(*glb), out.bvh = std::move(*text);
  if (placed.repeated)
    out.notes.push_back(
        "its clip repeats, which its file does not: GLB and BVH hold the skeleton and its motion, no mesh");
  else if (!gltf && !bvh)
    out.notes.push_back(original.format + " cannot be written: GLB and BVH hold the skeleton and its motion, no mesh");
  return out;
}

}  // namespace ft::inline io

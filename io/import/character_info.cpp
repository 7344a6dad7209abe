#include "io/import/character_info.h"

#include <algorithm>

#include "io/import/body/bind.h"
#include "io/import/body/skin.h"
#include "io/import/character/choose_meshes.h"
#include "io/import/character/pose.h"
#include "io/import/files/read_geometry_cache.h"
#include "io/import/import.h"
#include "io/import/import_cache.h"
#include "io/import/motion/placement.h"
#include "io/import/repair/facing.h"

namespace ft::inline io {

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
  info.contents = character.contents;
  info.notes.insert(info.notes.begin(), character.notes.begin(), character.notes.end());
}

Result<CharacterInfo> inspect_character(const std::filesystem::path& file, const ImportLimits& limits) {
  CharacterInfo info;
  if (is_geometry_cache(file)) {
    auto cache = read_geometry_cache(file, {}, 0, false);
    if (!cache) return cache.error();
    info.format = cache->format, info.up = std::string("y");
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
  std::vector<std::string> hidden;
  const std::vector<int> meshes = visible_meshes(character, hidden);
  if (std::string note = hidden_note(hidden); !note.empty()) info.notes.push_back(std::move(note));
  describe(character, meshes, info);
  info.unit_scale = placement->unit_scale, info.up = placement->up;
  Skin skin = weld(character, meshes, info.notes);
  const ClipPose rest(character, nullptr);
  std::vector<Vec3> positions(skin.base.size());
  deform(skin, placement->matrix(), bind.globals, rest.rest_morphs(), positions);
  for (std::string& note : turn_outwards(positions, skin.surface.triangles).notes())
    info.notes.push_back(std::move(note));
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

// What an import is asked for, and what it gives.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "baker/core/hash.h"
#include "baker/core/trajectory.h"
#include "io/import/character/character.h"
#include "io/reading/guarded_child.h"

namespace ft::inline io {

using ImportLimits = ChildLimits;

struct ClipInfo {
  std::string name;
  double start = 0, duration = 0;  ///< s; first key, last key - first key
  int channel_count = 0;
};

struct CharacterInfo {
  std::string format;
  int vertex_count = 0, triangle_count = 0, node_count = 0, bone_count = 0, morph_count = 0;
  double unit_scale = 1;  ///< m per file unit that was applied
  std::string up;
  Box bind_bounds;  ///< m
  std::vector<ClipInfo> clips;
  std::vector<std::string> mesh_names;
  std::vector<SurfacePart> parts;  ///< of an inspected file; of an imported one its trajectory has them
  std::vector<CharacterContent> contents;
  std::vector<int> seam_frames;    ///< first frames after the end of a cycle, of a clip that repeats
  bool still = false;              ///< there is nothing to play, and a note says so
  std::vector<std::string> notes;  ///< what was repaired or is odd: "weights normalised (sums 0.185..1.0)"
};

struct ImportRequest {
  std::filesystem::path file, animation, topology;
  std::string clip;
  double clip_start = 0, speed = 1;
  bool loop = false;                ///< the clip repeats, carried on from cycle to cycle
  std::optional<double> clip_bind;  ///< geometry caches: where garments are modelled; none: at clip_start
  double unit_scale = 0;            ///< 0: as the file says
  std::string up;                   ///< "": as the file says
  double source_fps = 0;            ///< geometry caches; 0: shot_fps
  double shot_fps = 24;
  std::string body = "blended";
  double height = 0;  ///< 0: as it is
  std::string bind;   ///< "t_pose": garments are modelled on one; empty: on the file's bind pose
  std::vector<std::string> meshes;
  std::string surface;                 ///< geometry caches: "solid", "sheet"; empty: as the mesh says
  double preroll = 1;                  ///< s
  double duration = 0;                 ///< s of the shot: frames outside the clip are refused
  int first_frame = 0;                 ///< of the shot, for messages
  bool keep_character = false;         ///< for who changes its motion, see placed_character.h
  std::filesystem::path cache_folder;  ///< import cache; empty: none
  ImportLimits limits;
};

struct PlacedCharacter;

struct ImportedPrimary {
  std::unique_ptr<Trajectory> trajectory;
  /// What the trajectory was made of, where `keep_character` asked for it; null for geometry caches.
  std::shared_ptr<const PlacedCharacter> character;
  CharacterInfo info;
  Hash128 content;  ///< hash of the input bytes
};

}  // namespace ft::inline io

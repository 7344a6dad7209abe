// The bakes of a sweep: every clip of every character below assets/characters and assets/mocap, and a half of all clips
// on characters that they were not made for. For sweep_tool.cpp. A folder's files with a mesh, and motion capture, are
// bodies; its files with a motion only are clips of these bodies. What is drawn by lot depends on the seed and on names
// alone, so that a new character changes nothing of the others' bakes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "baker/core/result.h"

namespace ft::bench {

struct SweepSettings {
  std::filesystem::path assets, import_cache;
  std::filesystem::path motions;  ///< where clips go that were put onto another character, see sweep_retarget.h
  std::uint64_t seed = 1;
  int most_frames = 48;  ///< of a clip that is longer, a part is played that is drawn by lot
};

struct SweepBake {
  std::string name;                       ///< of the bake: letters that a folder may have
  std::string character;                  ///< who wears the garments
  std::filesystem::path file, animation;  ///< animation: empty where the clip is in `file`
  std::string clip;
  double clip_start = 0;  ///< s
  double fps = 24;        ///< the clip's own where it is 24 to 30 or a multiple of that; else 24
  int frame_count = 0;
  std::vector<std::string> meshes;  ///< that make the body; empty: all
  double height = 0;                ///< m; 0: as the file says
};

/// In an order drawn by lot: the first tenth is a sample of all. `notes` says what was left out.
Result<std::vector<SweepBake>> list_sweep(const SweepSettings& settings, std::vector<std::string>& notes);

/// A bake a line, fields parted by tabs, "-" for what is empty.
std::string to_lines(const std::vector<SweepBake>& bakes);
Result<std::vector<SweepBake>> read_sweep_list(const std::filesystem::path& file);

}  // namespace ft::bench

// The two halves of import_primary() for a character: all that is decided about it, and the Trajectory made of it.
// Between them its motion may be changed (adjust.h, motion_change.h).
#pragma once

#include "io/import/body/bind.h"
#include "io/import/character/import_request.h"
#include "io/import/motion/character_trajectory.h"

namespace ft::inline io {

struct PlacedCharacter {
  Character character;                ///< with the clips of the animation file, where there is one
  int clip = -1;                      ///< into its clips; -1: the rest pose
  bool repeated = false;              ///< the clip is as long as the shot, and the file's once over (cycle.h)
  int pelvis = 0;                     ///< the node above everything that carries vertices
  Mat4 placement = Mat4::Identity();  ///< file units and axes to metres and Y-up
  Playback playback;
  Skin skin;
  BindPose bind;
  CharacterInfo info;
  Hash128 content;
};

/// Errors are those of import_primary(). Not for geometry caches.
Result<PlacedCharacter> place_character(const ImportRequest& request);
Result<ImportedPrimary> play(PlacedCharacter placed, const ImportRequest& request);

}  // namespace ft::inline io

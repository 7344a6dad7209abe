// The files that an adjusted motion goes back to the animator in: an edited copy of the file that the motion came from,
// and the skeleton alone in the other format.
#pragma once

#include "io/export/bvh_export.h"
#include "io/import/motion/placed_character.h"

namespace ft::inline io {

struct MotionFiles {
  Bytes glb;
  std::string bvh;
  std::vector<std::string> notes;  ///< what is not the original's
};

/// placed: as place_character() gave it for the request, with the motion of the file. From glTF the .glb is the copy of
/// the character's file, or of its animation file, with the changed channels, and the .bvh is made of the skeleton at
/// `frames`; from BVH it is the other way round. FBX, Collada and the rest cannot be edited: both are made of the
/// skeleton. No FBX is written: assimp 5.2.5 cannot read its own binary FBX again, and its text FBX loses most keys.
Result<MotionFiles> export_motion(const ImportRequest& request, const PlacedCharacter& placed,
                                  std::span<const ChangedChannel> changes, const BvhFrames& frames);

}  // namespace ft::inline io

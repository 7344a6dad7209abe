// The pose that garments are modelled on. A file's nodes may rest anywhere (often in the first frame of some clip);
// what the mesh was bound to is in the inverse bind matrices. Also: which node is the pelvis, whose place and heading
// are the character's.
#pragma once

#include <vector>

#include "io/import/character/character.h"

namespace ft::inline io {

struct BindPose {
  std::vector<Mat4> locals, globals;  ///< one per node, file units and axes
  bool from_inverse_binds = false;    ///< the rest pose was another
};

BindPose find_bind_pose(const Character& character);

/// The deepest node above everything that carries vertices of the chosen meshes.
int find_pelvis(const Character& character, const std::vector<int>& meshes);

}  // namespace ft::inline io

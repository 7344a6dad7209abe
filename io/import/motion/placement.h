// From file units and axes to metres and Y-up. What the file says is believed unless the user says otherwise, and the
// result is looked at: characters a hundred times too large are the most frequent fault of all.
#pragma once

#include <string>
#include <vector>

#include "io/import/character/character.h"
#include "io/import/character/import_request.h"

namespace ft::inline io {

struct Placement {
  double unit_scale = 1;  ///< m per file unit
  Mat3 axes = Mat3::Identity();
  std::string up = "y";
  bool unit_given = false;
  Mat4 matrix() const;
};

/// unit_scale 0 and up "" leave what the file says. A BVH says nothing: its unit is the one of the usual six that
/// makes the skeleton nearest to human size, its up axis the one from the hips to the head; both are noted.
Result<Placement> find_placement(const Character& character, double unit_scale, const std::string& up,
                                 const std::vector<Mat4>& bind_globals, std::vector<std::string>& notes);

/// Rotation that takes "x", "y" or "z" (or "-z") to +Y.
Result<Mat3> axes_from_up(const std::string& up);

/// "y", "z" or one of them with a minus: where a direction points most.
std::string main_axis(const Vec3& direction);

/// Refuses a character that is not between 0.3 and 4 m tall, saying how tall it is and how to mend it.
Status check_height(double height, const Placement& placement, const std::string& file);

/// Where all nodes are: the extent of a skeleton without a surface.
Box node_bounds(const std::vector<Mat4>& globals);

}  // namespace ft::inline io

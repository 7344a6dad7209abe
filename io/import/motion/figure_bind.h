// Which pose is the bind pose: the file's, the one in which a character without a body gets one, or the T-pose that a
// shot asks for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/import/body/bind.h"
#include "io/import/character/import_request.h"
#include "io/import/motion/placement.h"

namespace ft::inline io {

/// A skeleton that does not rest as a figure (all bones along one axis, as in Rokoko's and LaFAN1's files) gives a
/// torn body. Its pose is then a T-pose made from the most upright of the clip's poses; where its joints are not known,
/// the clip's first pose as it is. Nothing where it rests as it should, or stays as it is for want of a clip. What was
/// done is a note. up: the shot's, or empty.
Result<std::optional<BindPose>> standing_pose(const Character& character, const Clip* clip, const std::string& up,
                                              std::vector<std::string>& notes);

/// bind = "t_pose": the bind pose with arms level and legs straight. Joints that were not found are listed in the
/// error.
Result<BindPose> asked_t_pose(const Character& character, const BindPose& bind, const Mat3& axes,
                              const std::string& file, std::vector<std::string>& notes);

/// The pose that garments are modelled on and where it is. A BVH gets its body here (add_body()). Guesses are notes.
Result<Placement> place_bind_pose(Character& character, const Clip* clip, const ImportRequest& request, BindPose& bind,
                                  std::vector<std::string>& notes);

}  // namespace ft::inline io

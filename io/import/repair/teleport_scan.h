// Looks at a primary's whole trajectory before the bake, for jumps between two frames that no motion explains: the
// body, or a part of it, is elsewhere in the next frame and moves neither before nor after as if it were going there.
// For the plan of a bake; what is done about a jump of the whole body is baker/core/teleport.h. Depends on the
// trajectory alone, so a resume finds the same. Caution: what is quick and real must never count. A kick moves a foot
// by 0.6 m in a frame, and its neighbours say so.
#pragma once

#include <string>
#include <vector>

#include "baker/core/teleport.h"
#include "baker/core/trajectory.h"

namespace ft::inline io {

/// A part that jumps while the body does not; nothing can be carried along.
struct PartJump {
  int frame = 0;        ///< first frame at the new place
  std::string part;     ///< the one that jumps farthest
  int part_count = 0;   ///< that jump in this frame
  double distance = 0;  ///< m
};

struct TeleportScan {
  std::vector<Teleport> teleports;   ///< by frame
  std::vector<double> distances;     ///< m, of the body's middle, one per teleport
  std::vector<double> turns;         ///< rad, one per teleport
  std::vector<PartJump> part_jumps;  ///< by frame
};

struct TeleportScanSettings {
  int first_frame = 1, last_frame = 1, preroll_frames = 0;
  double fps = 24;
  bool detect = true;
  std::vector<int> frames;  ///< these are teleports whatever the motion looks like
};

TeleportScan scan_teleports(const Trajectory& trajectory, const TeleportScanSettings& settings);

/// One sentence per jump, at most `most` and a count of the rest.
std::vector<std::string> teleport_notes(const TeleportScan& scan, const std::string& primary, std::size_t most = 8);

}  // namespace ft::inline io

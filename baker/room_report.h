// Before a bake: where and when its primaries leave no room for the cloth they wear. For --dry-run and info --scan (a
// few lines: the worst pairs of parts and their frames) and report.json (all of them). What is done about it is
// collision/feasible_collider.h.
#pragma once

#include <string>
#include <vector>

#include "baker/core/types.h"
#include "baker/report_json.h"

namespace ft {

struct BakePlan;

/// Two parts that are too near to each other over a range of frames (breaks of a frame or two are bridged).
struct RoomPlace {
  std::string primary, part_a, part_b;  ///< a gives way to b
  int first_frame = 0, last_frame = 0, worst_frame = 0;
  double clearance = 0;       ///< smallest [m]; negative: overlap
  Vec3 place = Vec3::Zero();  ///< then and there [m]
};

struct RoomReport {
  std::vector<RoomPlace> places;  ///< worst first
  int frame_count = 0;
  double seconds = 0;  ///< wall
};

/// All frames of the shot, the pre-roll's as well. Pairs of which neither part wears cloth do not count.
RoomReport find_room(const BakePlan& plan);

std::vector<std::string> room_lines(const RoomReport& report, std::size_t most = 6);
Json to_json(const RoomReport& report);

}  // namespace ft

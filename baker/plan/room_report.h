// Before a bake: where and when its primaries leave no room for the cloth they wear. For --dry-run and info --scan (a
// few lines: the worst pairs of parts and their frames) and report.json (all of them). What is done about it is
// collision/body/feasible_collider.h; where a part is so deep in another that nothing can be done, it is absent for the
// cloth.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "baker/core/types.h"
#include "baker/record/report_json.h"

namespace ft::inline baker {

struct BakePlan;

/// Two parts that are too near to each other over a range of frames (breaks of a frame or two are bridged).
struct RoomPlace {
  std::string primary, part_a, part_b;  ///< a gives way to b
  int first_frame = 0, last_frame = 0, worst_frame = 0;
  double clearance = 0;       ///< smallest [m]; negative: overlap
  Vec3 place = Vec3::Zero();  ///< then and there [m]
};

/// A part of which some is absent for the cloth over a range of frames (breaks of a frame or two are bridged): the body
/// is too deep in itself there, see collision/body/absent_vertices.h.
struct AbsentPlace {
  std::string primary, part;
  std::string inside;  ///< the part that leaves it no room in the worst frame; empty: a joint folds there
  int first_frame = 0, last_frame = 0, worst_frame = 0;
  double share = 0;  ///< of its vertices, at worst
};

struct RoomReport {
  std::vector<RoomPlace> places;    ///< worst first
  std::vector<AbsentPlace> absent;  ///< worst first
  int frame_count = 0;
  double seconds = 0;  ///< wall
};

/// All frames of the shot, the pre-roll's as well. Pairs of which neither part wears cloth do not count, nor do parts
/// that no garment meets.
RoomReport find_room(const BakePlan& plan);

/// Of the stages of a bake.
RoomReport merged(std::span<const RoomReport> stages);

std::vector<std::string> room_lines(const RoomReport& report, std::size_t most = 6);
Json to_json(const RoomReport& report);

}  // namespace ft::inline baker

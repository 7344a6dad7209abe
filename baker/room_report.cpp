#include "baker/room_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>

#include "baker/core/parallel.h"
#include "baker/plan.h"
#include "collision/room_scan.h"

namespace ft {
namespace {

constexpr int k_bridged_frames = 2;

/// Per part: whether it is the nearest of the body to some vertex of a garment in the bind pose.
std::vector<char> wearing_parts(const GroupPlan& group, const Trajectory& body) {
  const Surface& surface = body.surface();
  const std::vector<Vec3> bind = bind_pose_of(body);
  std::vector<char> out(surface.parts.size(), 0);
  for (const ClothGarment& garment : group.setup.garments) {
    const auto& x = garment.mesh.positions;
    const std::size_t stride = std::max<std::size_t>(1, x.size() / 2000);
    std::vector<int> nearest((x.size() + stride - 1) / stride);
    parallel_for(nearest.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t v = 0; v < bind.size(); ++v)
          if (const double d = (bind[v] - x[i * stride]).squaredNorm(); d < least)
            least = d, nearest[i] = surface.part_of_vertex[v];
      }
    });
    for (const int part : nearest) out[at(part)] = 1;
  }
  return out;
}

void add_places(const BakePlan& plan, const GroupPlan& group, RoomReport& report) {
  const Shot& shot = plan.shot();
  const PrimaryPlan& primary = plan.primaries[group.primary];
  if (!group.setup.feasible.carve || !group.setup.primary || group.setup.garments.empty()) return;
  const Trajectory& body = *group.setup.primary;
  const auto& parts = body.surface().parts;
  if (parts.size() < 2) return;
  const RoomScanner scanner(group.setup.poses);
  const std::vector<char> wears = wearing_parts(group, body);
  const int first = shot.first_frame - shot.preroll;
  const std::size_t count = at(shot.last_frame - first + 1);
  std::vector<std::vector<TightPlace>> tight(count);
  parallel_tasks(count, [&](std::size_t k) {
    tight[k] = scanner.look((first + static_cast<int>(k) - shot.first_frame) / shot.fps);
  });
  report.frame_count += static_cast<int>(count);
  std::map<std::pair<int, int>, RoomPlace> open;
  for (std::size_t k = 0; k < count; ++k) {
    const int frame = first + static_cast<int>(k);
    for (const TightPlace& now : tight[k]) {
      if (!wears[at(now.part_a)] && !wears[at(now.part_b)]) continue;
      RoomPlace fresh{
          primary.name, parts[at(now.part_a)].name, parts[at(now.part_b)].name, frame, frame, frame, now.clearance,
          now.place};
      const auto [entry, is_new] = open.try_emplace({now.part_a, now.part_b}, fresh);
      if (is_new) continue;
      RoomPlace& place = entry->second;
      if (frame > place.last_frame + 1 + k_bridged_frames) {
        report.places.push_back(std::move(place));
        place = std::move(fresh);
        continue;
      }
      place.last_frame = frame;
      if (now.clearance < place.clearance)
        place.clearance = now.clearance, place.worst_frame = frame, place.place = now.place;
    }
  }
  for (auto& [pair, place] : open) report.places.push_back(std::move(place));
}

}  // namespace

RoomReport find_room(const BakePlan& plan) {
  const auto clock = std::chrono::steady_clock::now();
  RoomReport report;
  for (const GroupPlan& group : plan.groups) add_places(plan, group, report);
  std::stable_sort(report.places.begin(), report.places.end(),
                   [](const RoomPlace& a, const RoomPlace& b) { return a.clearance < b.clearance; });
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return report;
}

std::vector<std::string> room_lines(const RoomReport& report, std::size_t most) {
  std::vector<std::string> out;
  if (report.frame_count == 0) return out;
  if (report.places.empty())
    out.push_back(fmt::format("room: enough for the cloth in all {} frames", report.frame_count));
  for (std::size_t i = 0; i < std::min(most, report.places.size()); ++i) {
    const RoomPlace& p = report.places[i];
    const std::string how = p.clearance < 0 ? fmt::format("is {:.1f} mm inside", -1e3 * p.clearance)
                                            : fmt::format("is only {:.1f} mm from", 1e3 * p.clearance);
    const std::string frames = p.first_frame == p.last_frame
                                   ? fmt::format("frame {}", p.first_frame)
                                   : fmt::format("frames {}-{}, worst {}", p.first_frame, p.last_frame, p.worst_frame);
    out.push_back(fmt::format("no room: \"{}\" of \"{}\" {} \"{}\", {}", p.part_a, p.primary, how, p.part_b, frames));
  }
  if (report.places.size() > most) out.push_back(fmt::format("no room: {} more places", report.places.size() - most));
  return out;
}

Json to_json(const RoomReport& report) {
  Json places = Json::array();
  for (const RoomPlace& p : report.places)
    places.push_back({{"primary", p.primary},
                      {"part", p.part_a},
                      {"other", p.part_b},
                      {"first_frame", p.first_frame},
                      {"last_frame", p.last_frame},
                      {"worst_frame", p.worst_frame},
                      {"clearance", p.clearance},
                      {"place", {p.place.x(), p.place.y(), p.place.z()}}});
  return Json{{"frames", report.frame_count}, {"seconds", report.seconds}, {"places", std::move(places)}};
}

}  // namespace ft

#include "baker/plan/room_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "baker/plan/plan.h"

namespace ft::inline baker {
namespace {

/// Where less of a part is absent, no line is made of it.
constexpr double k_notable_share = 0.05;

void sort_worst_first(RoomReport& report) {
  std::stable_sort(report.places.begin(), report.places.end(),
                   [](const RoomPlace& a, const RoomPlace& b) { return a.clearance < b.clearance; });
  std::stable_sort(report.absent.begin(), report.absent.end(),
                   [](const AbsentPlace& a, const AbsentPlace& b) { return a.share > b.share; });
}

}  // namespace

RoomReport merged(std::span<const RoomReport> stages) {
  RoomReport out;
  for (const RoomReport& stage : stages) {
    out.places.insert(out.places.end(), stage.places.begin(), stage.places.end());
    out.absent.insert(out.absent.end(), stage.absent.begin(), stage.absent.end());
    out.frame_count += stage.frame_count;
    out.seconds += stage.seconds;
  }
  sort_worst_first(out);
  return out;
}

RoomReport find_room(const BakePlan& plan) {
  const auto clock = std::chrono::steady_clock::now();
  RoomReport report;
  for (const auto& group : plan.groups) group->add_room(plan, report);
  sort_worst_first(report);
  report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  return report;
}

namespace {

/// "frames 22-31, worst 24".
template <class Place>
std::string frames_of(const Place& p) {
  return p.first_frame == p.last_frame
             ? fmt::format("frame {}", p.first_frame)
             : fmt::format("frames {}-{}, worst {}", p.first_frame, p.last_frame, p.worst_frame);
}

}  // namespace

std::vector<std::string> room_lines(const RoomReport& report, std::size_t most) {
  std::vector<std::string> out;
  if (report.frame_count == 0) return out;
  if (report.places.empty())
    out.push_back(fmt::format("room: enough for the cloth in all {} frames", report.frame_count));
  for (std::size_t i = 0; i < std::min(most, report.places.size()); ++i) {
    const RoomPlace& p = report.places[i];
    const std::string how = p.clearance < 0 ? fmt::format("is {:.1f} mm inside", -1e3 * p.clearance)
                                            : fmt::format("is only {:.1f} mm from", 1e3 * p.clearance);
    out.push_back(
        fmt::format("no room: \"{}\" of \"{}\" {} \"{}\", {}", p.part_a, p.primary, how, p.part_b, frames_of(p)));
  }
  if (report.places.size() > most) out.push_back(fmt::format("no room: {} more places", report.places.size() - most));
  std::size_t told = 0;
  for (const AbsentPlace& p : report.absent) {
    if (told == most || p.share < k_notable_share) break;
    ++told;
    out.push_back(fmt::format("absent for the cloth: {:.0f} % of \"{}\" of \"{}\" at worst, {}{}", 100 * p.share,
                              p.part, p.primary, frames_of(p),
                              p.inside.empty() ? "" : " (inside \"" + p.inside + "\")"));
  }
  if (report.absent.size() > told)
    out.push_back(
        fmt::format("absent for the cloth: some of parts in {} more ranges of frames", report.absent.size() - told));
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
  Json absent = Json::array();
  for (const AbsentPlace& p : report.absent)
    absent.push_back({{"primary", p.primary},
                      {"part", p.part},
                      {"inside", p.inside},
                      {"first_frame", p.first_frame},
                      {"last_frame", p.last_frame},
                      {"worst_frame", p.worst_frame},
                      {"share", p.share}});
  return Json{{"frames", report.frame_count},
              {"seconds", report.seconds},
              {"places", std::move(places)},
              {"absent", std::move(absent)}};
}

}  // namespace ft::inline baker

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
/// Where less of a part is absent, no line is made of it.
constexpr double k_notable_share = 0.05;

/// Places over ranges of frames, from what is found frame after frame under the same key.
template <class Key, class Place>
class Ranges {
 public:
  explicit Ranges(std::vector<Place>& done) : done_(done) {}
  /// worse: whether the first is worse than the second.
  template <class Worse>
  void add(const Key& key, int frame, Place fresh, Worse&& worse) {
    fresh.first_frame = fresh.last_frame = fresh.worst_frame = frame;
    const auto [entry, is_new] = open_.try_emplace(key, fresh);
    if (is_new) return;
    Place& place = entry->second;
    if (frame > place.last_frame + 1 + k_bridged_frames) {
      done_.push_back(std::move(place));
      place = std::move(fresh);
      return;
    }
    if (worse(fresh, place)) fresh.first_frame = place.first_frame, place = std::move(fresh);
    place.last_frame = frame;
  }
  void finish() {
    for (auto& [key, place] : open_) done_.push_back(std::move(place));
  }

 private:
  std::vector<Place>& done_;
  std::map<Key, Place> open_;
};

/// Per part: whether some garment meets it.
std::vector<char> met_parts(const GroupPlan& group, std::size_t part_count) {
  std::vector<std::size_t> ignored_by(part_count, 0);
  for (const ClothGarment& garment : group.setup.garments)
    for (const int part : garment.ignores) ++ignored_by[at(part)];
  std::vector<char> out;
  for (const std::size_t count : ignored_by) out.push_back(count < group.setup.garments.size());
  return out;
}

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
  std::vector<std::vector<double>> absent(count, std::vector<double>(parts.size()));
  parallel_tasks(count, [&](std::size_t k) {
    tight[k] = scanner.look((first + static_cast<int>(k) - shot.first_frame) / shot.fps, absent[k]);
  });
  report.frame_count += static_cast<int>(count);
  const std::vector<char> met = met_parts(group, parts.size());
  // Of several bodies, a part goes with its own primary's name.
  const auto owner = [&](int part) {
    return group.joint ? group.joint->members()[group.joint->member_of_part(part)].name : primary.name;
  };
  const auto name = [&](int part) {
    const std::string &full = parts[at(part)].name, start = owner(part) + ".";
    return group.joint && full.starts_with(start) ? full.substr(start.size()) : full;
  };
  const auto other = [&](int part, int of) { return owner(part) == owner(of) ? name(part) : parts[at(part)].name; };
  Ranges<std::pair<int, int>, RoomPlace> places(report.places);
  Ranges<std::size_t, AbsentPlace> absences(report.absent);
  for (std::size_t k = 0; k < count; ++k) {
    const int frame = first + static_cast<int>(k);
    std::vector<const TightPlace*> tightest(parts.size(), nullptr);
    for (const TightPlace& now : tight[k]) {
      const TightPlace*& known = tightest[at(now.part_a)];
      if (known == nullptr || now.clearance < known->clearance) known = &now;
      if (!wears[at(now.part_a)] && !wears[at(now.part_b)]) continue;
      if (!met[at(now.part_a)] || !met[at(now.part_b)]) continue;
      RoomPlace place{owner(now.part_a), name(now.part_a), other(now.part_b, now.part_a), frame, frame, frame,
                      now.clearance,     now.place};
      places.add({now.part_a, now.part_b}, frame, std::move(place),
                 [](const RoomPlace& a, const RoomPlace& b) { return a.clearance < b.clearance; });
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (absent[k][p] <= 0 || !met[p]) continue;
      const TightPlace* by = tightest[p];
      const int part = static_cast<int>(p);
      AbsentPlace place{owner(part), name(part),  by == nullptr ? "" : other(by->part_b, part), frame, frame,
                        frame,       absent[k][p]};
      absences.add(p, frame, std::move(place),
                   [](const AbsentPlace& a, const AbsentPlace& b) { return a.share > b.share; });
    }
  }
  places.finish();
  absences.finish();
}

}  // namespace

RoomReport find_room(const BakePlan& plan) {
  const auto clock = std::chrono::steady_clock::now();
  RoomReport report;
  for (const GroupPlan& group : plan.groups) add_places(plan, group, report);
  std::stable_sort(report.places.begin(), report.places.end(),
                   [](const RoomPlace& a, const RoomPlace& b) { return a.clearance < b.clearance; });
  std::stable_sort(report.absent.begin(), report.absent.end(),
                   [](const AbsentPlace& a, const AbsentPlace& b) { return a.share > b.share; });
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

}  // namespace ft

// Where a clip leaves no room for the cloth that is worn.
#include <algorithm>
#include <limits>
#include <map>

#include "baker/core/parallel.h"
#include "baker/plan/room_report.h"
#include "baker/systems/cloth/cloth_group.h"
#include "collision/body/room_scan.h"

namespace ft::inline baker {
namespace {

constexpr int k_bridged_frames = 2;

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
std::vector<char> met_parts(const ClothGroup& group, std::size_t part_count) {
  std::vector<std::size_t> ignored_by(part_count, 0);
  for (const ClothGarment& garment : group.setup.garments)
    for (const int part : garment.ignores) ++ignored_by[at(part)];
  std::vector<char> out;
  for (const std::size_t count : ignored_by) out.push_back(count < group.setup.garments.size());
  return out;
}

/// Per part: whether it is the nearest of the body to some vertex of a garment in the bind pose.
std::vector<char> wearing_parts(const ClothGroup& group, const Trajectory& body) {
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

}  // namespace

void ClothGroup::add_room(const BakePlan& plan, RoomReport& report) const {
  const Shot& shot = plan.shot();
  const PrimaryPlan& wearer = plan.primaries[primary];
  if (!setup.feasible.carve || !setup.primary || setup.garments.empty()) return;
  const Trajectory& body = *setup.primary;
  const auto& parts = body.surface().parts;
  if (parts.size() < 2) return;
  const RoomScanner scanner(setup.poses);
  const std::vector<char> wears = wearing_parts(*this, body);
  const int first = shot.first_frame - shot.preroll;
  const std::size_t count = at(shot.last_frame - first + 1);
  std::vector<std::vector<TightPlace>> tight(count);
  std::vector<std::vector<double>> absent(count, std::vector<double>(parts.size()));
  parallel_tasks(count, [&](std::size_t k) {
    tight[k] = scanner.look((first + static_cast<int>(k) - shot.first_frame) / shot.fps, absent[k]);
  });
  report.frame_count += static_cast<int>(count);
  const std::vector<char> met = met_parts(*this, parts.size());
  // Of several bodies, a part goes with its own primary's name.
  const auto owner = [&](int part) { return joint ? joint->members()[joint->member_of_part(part)].name : wearer.name; };
  const auto name = [&](int part) {
    const std::string &full = parts[at(part)].name, start = owner(part) + ".";
    return joint && full.starts_with(start) ? full.substr(start.size()) : full;
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

}  // namespace ft::inline baker

// Velocities of what moves by itself: differences of the cached positions, so that they agree with what is drawn.
#include <algorithm>

#include "baker/run/cache_set.h"
#include "baker/run/converted.h"

namespace ft::inline baker {

std::vector<Vec3> CacheSet::velocities_of(const Source& source, int frame, std::span<const Vec3> x,
                                          std::span<const Vec3f> before, std::span<const Vec3f> after) const {
  std::vector<Vec3> from(x.begin(), x.end()), to = from;
  // Motion blur must not see the way from one place to the other; water stays where it is.
  const std::span<const Teleport> teleports =
      source.flows ? std::span<const Teleport>() : std::span(plan_.primaries[source.primary].scan.teleports);
  if (!before.empty()) {
    from = converted<Vec3, Vec3f>(before);
    if (const Teleport* teleport = teleport_into(teleports, frame)) carry(*teleport, std::span(from));
  }
  if (!after.empty()) {
    to = converted<Vec3, Vec3f>(after);
    if (const Teleport* teleport = teleport_into(teleports, frame + 1))
      carry(Teleport{.frame = frame, .motion = teleport->motion.inverse()}, std::span(to));
  }
  const double per_second = plan_.shot().fps / std::max(1, int{!before.empty()} + int{!after.empty()});
  for (std::size_t k = 0; k < x.size(); ++k) to[k] = (to[k] - from[k]) * per_second;
  return to;
}

std::vector<std::vector<float>> CacheSet::to_numbers(const Snapshot& before) const {
  std::vector<std::vector<float>> out(sources_.size());
  for (std::size_t i = 0; i < sources_.size(); ++i)
    if (has_differences(i))
      for (const Vec3f& p : before.systems[i].positions) out[i].insert(out[i].end(), p.data(), p.data() + 3);
  return out;
}

std::shared_ptr<const Snapshot> CacheSet::from_numbers(int frame,
                                                       const std::vector<std::vector<float>>& numbers) const {
  if (numbers.size() != sources_.size()) return nullptr;
  auto out = std::make_shared<Snapshot>();
  out->frame = frame;
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    std::vector<Vec3f>& positions = out->systems.emplace_back().positions;
    if (numbers[i].size() != (has_differences(i) ? 3 * at(systems_[i].vertex_count) : 0)) return nullptr;
    for (std::size_t k = 0; k < numbers[i].size(); k += 3)
      positions.emplace_back(numbers[i][k], numbers[i][k + 1], numbers[i][k + 2]);
  }
  return out;
}

}  // namespace ft::inline baker

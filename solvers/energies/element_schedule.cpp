#include "solvers/energies/element_schedule.h"

#include <algorithm>
#include <cstdint>

#include "baker/core/give_back.h"

namespace ft::inline solvers {
namespace {

/// Spreads the lower 10 bits, two zeros between each.
std::uint32_t spread(std::uint32_t v) {
  v = (v | (v << 16)) & 0x030000FFu;
  v = (v | (v << 8)) & 0x0300F00Fu;
  v = (v | (v << 4)) & 0x030C30C3u;
  return (v | (v << 2)) & 0x09249249u;
}

std::uint32_t morton(const Vec3& p, const Box& box) {
  const double size = std::max(box.size().maxCoeff(), 1e-12);
  const Vec3 q = ((p - box.lo) * (1023 / size)).cwiseMax(0.0).cwiseMin(1023.0);
  return spread(static_cast<std::uint32_t>(q.x())) | spread(static_cast<std::uint32_t>(q.y())) << 1 |
         spread(static_cast<std::uint32_t>(q.z())) << 2;
}

}  // namespace

ElementSchedule make_element_schedule(std::span<const int> vertices, std::size_t corners, std::span<const Vec3> rest,
                                      std::vector<int>& element_of_slot) {
  const std::size_t count = vertices.size() / corners;
  const auto element = [&](std::size_t i) { return vertices.subspan(i * corners, corners); };
  ElementSchedule out;
  const Box box = bounds(rest);
  std::vector<std::pair<std::uint32_t, int>> keys(count);
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 centre = Vec3::Zero();
    int used = 0;
    for (const int v : element(i))
      if (v >= 0) centre += rest[at(v)], ++used;
    keys[i] = {morton(centre / std::max(used, 1), box), static_cast<int>(i)};
  }
  std::sort(keys.begin(), keys.end());
  out.count = count;
  element_of_slot.resize(count);
  for (std::size_t i = 0; i < count; ++i) element_of_slot[i] = keys[i].second;
  give_back(keys);

  // Greedy colours. A chunk that finds all 64 taken gets a colour of its own.
  std::vector<std::uint64_t> taken(rest.size(), 0);
  std::vector<std::vector<int>> own;
  constexpr std::size_t slots = k_chunk_groups * k_lanes;
  for (std::size_t chunk = 0; chunk * slots < count; ++chunk) {
    const std::size_t end = std::min(count, (chunk + 1) * slots);
    const auto for_each_vertex = [&](auto&& visit) {
      for (std::size_t s = chunk * slots; s < end; ++s)
        for (const int v : element(at(element_of_slot[s])))
          if (v >= 0) visit(taken[at(v)]);
    };
    std::uint64_t used = 0;
    for_each_vertex([&](std::uint64_t& t) { used |= t; });
    if (used == ~std::uint64_t{0}) {
      own.push_back({static_cast<int>(chunk)});
      continue;
    }
    int colour = 0;
    while (used >> colour & 1) ++colour;
    for_each_vertex([&](std::uint64_t& t) { t |= std::uint64_t{1} << colour; });
    if (out.colours.size() <= at(colour)) out.colours.resize(at(colour) + 1);
    out.colours[at(colour)].push_back(static_cast<int>(chunk));
  }
  out.colours.insert(out.colours.end(), own.begin(), own.end());
  return out;
}

}  // namespace ft::inline solvers

#include "baker/plan/meets.h"

#include <algorithm>

#include "io/shot/patterns.h"
#include "io/shot/words.h"

namespace ft::inline baker {
namespace {

/// What moves by no more than this stands still [m].
constexpr double k_still = 1e-9;

}  // namespace

Result<std::vector<char>> meets_of(std::span<const std::string> patterns, const std::string& own,
                                   std::span<const PrimaryPlan> primaries) {
  std::vector<std::string> names;
  for (const PrimaryPlan& primary : primaries) names.push_back(primary.name);
  const auto met = indices_like(patterns, names, "meets", "primary");
  if (!met) return met.error();
  std::vector<char> out(primaries.size(), 0);
  for (const int p : *met)  // a liquid is no body that patterns would mean
    out[at(p)] = !primaries[at(p)].flow || std::ranges::find(patterns, names[at(p)]) != patterns.end() ? 1 : 0;
  for (std::size_t p = 0; p < names.size(); ++p)
    if (names[p] == own) out[p] = 1;
  return out;
}

bool stands_still(const Shot& shot, const PrimaryPlan& primary) {
  const auto n = at(primary.trajectory->surface().vertex_count());
  std::vector<Vec3> first(n), now(n);
  primary.trajectory->sample(-shot.preroll / shot.fps, first);
  for (int frame = shot.first_frame - shot.preroll + 1; frame <= shot.last_frame; ++frame) {
    primary.trajectory->sample((frame - shot.first_frame) / shot.fps, now);
    for (std::size_t v = 0; v < n; ++v)
      if (!((now[v] - first[v]).norm() <= k_still)) return false;
  }
  return true;
}

bool is_two_way(const Shot& shot, const std::string& primary) {
  return std::any_of(shot.secondaries.begin(), shot.secondaries.end(), [&](const auto& s) {
    return (s->on == primary && s->coupling == "two-way") ||
           std::ranges::any_of(s->section->moves(*s), [&](const std::string& p) { return matches(p, primary); });
  });
}

std::string why_alone(const Shot& shot, const PrimaryPlan& primary) {
  if (is_two_way(shot, primary.name)) return "where it goes is only known once its secondaries are solved (two-way)";
  if (!primary.scan.teleports.empty()) return "it is cut to another place within the shot";
  return {};
}

}  // namespace ft::inline baker

#include "baker/commands/compare_primaries.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ft::inline baker {
namespace {

/// In a frame, from it and the two before: exact in free flight. Of the second frame from two, of the first none.
Vec3 velocity(const std::vector<Vec3>& x, int frame, double fps) {
  if (frame < 1) return Vec3::Zero();
  const Vec3 last = x[at(frame)] - x[at(frame - 1)];
  return fps * (frame < 2 ? last : Vec3(1.5 * last - 0.5 * (x[at(frame - 1)] - x[at(frame - 2)])));
}

std::string words(const Vec3& v) {
  const auto rounded = [](double x) { return 1e-6 * std::round(1e6 * x) + 0.0; };  // + 0.0: no -0
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", rounded(v.x()), rounded(v.y()), rounded(v.z()));
}

Json numbers(const Vec3& v) {
  return Json{v.x(), v.y(), v.z()};
}

}  // namespace

std::vector<PathComparison> compare_primaries(const std::vector<PrimaryPath>& a, const Manifest& manifest_a,
                                              const std::vector<PrimaryPath>& b, const Manifest& manifest_b) {
  std::vector<PathComparison> out;
  for (const PrimaryPath& in_a : a) {
    const auto in_b =
        std::find_if(b.begin(), b.end(), [&](const PrimaryPath& path) { return path.primary == in_a.primary; });
    if (in_b == b.end()) continue;
    const int start_a = manifest_a.first_written, start_b = manifest_b.first_written;
    const int first = std::max(start_a, start_b);
    const int last =
        std::min(start_a + static_cast<int>(in_a.centres.size()), start_b + static_cast<int>(in_b->centres.size())) - 1;
    if (last < first) continue;
    PathComparison& row = out.emplace_back();
    row.primary = in_a.primary;
    row.frame = first;
    for (int f = first; f <= last; ++f)
      if (const double apart = (in_a.centres[at(f - start_a)] - in_b->centres[at(f - start_b)]).norm();
          apart > row.largest)
        row.largest = apart, row.frame = f;
    row.velocity_a = velocity(in_a.centres, last - start_a, manifest_a.fps);
    row.velocity_b = velocity(in_b->centres, last - start_b, manifest_b.fps);
  }
  return out;
}

std::string to_text(const std::vector<PathComparison>& paths) {
  std::string out;
  for (const PathComparison& p : paths)
    out += p.largest == 0
               ? fmt::format("primary \"{}\": the same path in both\n", p.primary)
               : fmt::format(
                     "primary \"{}\": paths differ by up to {:.4g} m, at frame {}; in the end it moves at {} m/s "
                     "in a and {} m/s in b, {:.4g} m/s apart\n",
                     p.primary, p.largest, p.frame, words(p.velocity_a), words(p.velocity_b),
                     (p.velocity_a - p.velocity_b).norm());
  return out;
}

Json to_json(const std::vector<PathComparison>& paths) {
  Json out = Json::array();
  for (const PathComparison& p : paths)
    out.push_back({{"primary", p.primary},
                   {"largest", p.largest},
                   {"frame", p.frame},
                   {"end_velocity_a", numbers(p.velocity_a)},
                   {"end_velocity_b", numbers(p.velocity_b)}});
  return out;
}

}  // namespace ft::inline baker

#include "baker/commands/compare_scalars.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "baker/commands/compare.h"

namespace ft::inline baker {

ScalarsDifference paired_scalars(const CacheInfo& a, const CacheInfo& b) {
  const auto &names_a = a.content.scalars, &names_b = b.content.scalars;
  ScalarsDifference out;
  for (std::size_t i = 0; i < names_a.size(); ++i) {
    const auto twin = std::ranges::find(names_b, names_a[i]);
    if (twin == names_b.end())
      out.only_a.push_back(names_a[i]);
    else
      out.both.push_back({.name = names_a[i], .in_a = i, .in_b = static_cast<std::size_t>(twin - names_b.begin())});
  }
  for (const std::string& name : names_b)
    if (std::ranges::count(names_a, name) == 0) out.only_b.push_back(name);
  return out;
}

void compare_scalars(const FrameData& a, const FrameData& b, ScalarsDifference& all, FrameDifference& f) {
  for (std::size_t n = 0; n < all.both.size(); ++n) {
    ScalarDifference& one = all.both[n];
    const std::vector<float>&x = a.scalars[one.in_a], &y = b.scalars[one.in_b];
    for (std::size_t v = 0; v < x.size(); ++v) {
      const double d = std::abs(static_cast<double>(x[v]) - static_cast<double>(y[v]));
      if (d > one.max) one.max = d, one.frame = f.frame, one.vertex = static_cast<int>(v);
      if (d > f.scalar) f.scalar = d, f.scalar_vertex = static_cast<int>(v), f.scalar_index = static_cast<int>(n);
    }
  }
}

std::string scalars_text(const ScalarsDifference& all) {
  std::string out;
  for (const ScalarDifference& d : all.both)
    out += d.vertex < 0 ? fmt::format("  {}: no difference\n", d.name)
                        : fmt::format("  {}: max {:.4g} in frame {}, vertex {}\n", d.name, d.max, d.frame, d.vertex);
  for (const std::string& name : all.only_a) out += fmt::format("  {}: only a has it\n", name);
  for (const std::string& name : all.only_b) out += fmt::format("  {}: only b has it\n", name);
  return out;
}

}  // namespace ft::inline baker

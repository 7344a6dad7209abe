#include "io/shot/garment_size.h"

#include <fmt/format.h>

#include <cmath>

namespace ft::inline io {
namespace {

constexpr double k_smallest = 0.02, k_largest = 10;  ///< of what is not doubted [m]
constexpr double k_short = 0.1, k_long = 5;          ///< sizes that clothes have: what a unit is chosen for [m]

struct Unit {
  double scale;  ///< m
  const char* name;
};
/// The likeliest first. The last ones are of files that were converted to metres once too often.
constexpr Unit k_units[] = {{1, "metres"},          {0.01, "centimetres"},        {0.001, "millimetres"},
                            {0.0254, "inches"},     {100, "hundreds of metres"},  {0.1, "decimetres"},
                            {10, "tens of metres"}, {1000, "thousands of metres"}};

}  // namespace

std::string doubt_of_size(double size, double unit_scale) {
  if (!std::isfinite(size) || (size >= k_smallest && size <= k_largest) || size <= 0) return {};
  const double units = size / unit_scale;
  std::string out = fmt::format("is {:.3g} m in size, which no garment is", size);
  for (const Unit& unit : k_units)
    if (const double then = units * unit.scale; then >= k_short && then <= k_long)
      return out +
             fmt::format(": with unit_scale = {:g} (a file in {}) it would be {:.3g} m", unit.scale, unit.name, then);
  return out + ": is unit_scale right?";
}

}  // namespace ft::inline io

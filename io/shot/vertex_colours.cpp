#include "io/shot/vertex_colours.h"

#include <algorithm>

#include "io/shot/words.h"

namespace ft::inline io {
namespace {

/// A colour above it is no 1 that was rounded.
constexpr double k_most_above_one = 1.01;
constexpr double k_most_of_light = 2;  ///< fractions above it are of 0..255, too

}  // namespace

std::string scale_colours(std::vector<Vec3>& colours, double largest) {
  if (!(largest > k_most_above_one)) return {};
  const bool whole = std::all_of(colours.begin(), colours.end(),
                                 [](const Vec3& colour) { return colour.array().round().matrix() == colour; });
  const bool bytes = whole || largest > k_most_of_light;
  if (bytes)
    for (Vec3& colour : colours) colour /= k_largest_colour;
  return "vertex colours go up to " + number_text(largest) +
         (bytes ? ": they are read as 0 to 255" : ": what is above 1 counts as 1");
}

std::vector<VertexGroup> groups_of_colours(const std::vector<Vec3>& colours) {
  std::vector<VertexGroup> out;
  const char* names[3] = {"red", "green", "blue"};
  for (int channel = 0; channel < 3 && !colours.empty(); ++channel) {
    VertexGroup group{names[channel], {}, {}};
    for (std::size_t i = 0; i < colours.size(); ++i) {
      const double weight = std::clamp(colours[i][channel], 0.0, 1.0);
      if (weight > 0) group.vertices.push_back(static_cast<int>(i)), group.weights.push_back(weight);
    }
    if (!group.vertices.empty()) out.push_back(std::move(group));
  }
  return out;
}

}  // namespace ft::inline io

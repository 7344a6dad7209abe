// A slice is where the way has one value: a polyline across a strip, a circle about a tube. Its centre is that of its
// length, so that it does not matter where the mesh has its vertices. The line is led on beyond the first and the last
// slice as far as the mesh goes.
#include "io/hair/slices.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/disjoint_sets.h"

namespace ft::inline io {
namespace {

constexpr std::size_t k_slices_of_direction = 2;
/// A slice at an end that is so much shorter than the next one only cuts a corner off, for the corners of an end are
/// not reached at once.
constexpr double k_least_of_next = 0.8;

struct Range {
  std::size_t first, last;
};
/// Without what cuts corners off; at each end never more than about a sixteenth, for ends may fray.
Range whole_slices(std::span<const double> lengths) {
  Range out{0, lengths.size() - 1};
  const std::size_t most = (lengths.size() + 15) / 16;
  while (out.first < most && lengths[out.first] < k_least_of_next * lengths[out.first + 1]) ++out.first;
  while (lengths.size() - 1 - out.last < most && lengths[out.last] < k_least_of_next * lengths[out.last - 1])
    --out.last;
  return out;
}

/// Where a slice crosses a triangle: from one of its edges to another.
struct Crossing {
  std::array<Edge, 2> edges;
  std::array<Vec3, 2> ends;
};

struct Slice {
  std::vector<Crossing> crossings;

  double length() const {
    double out = 0;
    for (const Crossing& c : crossings) out += (c.ends[1] - c.ends[0]).norm();
    return out;
  }
  Vec3 centre() const {
    const double whole = length();
    Vec3 out = Vec3::Zero();
    for (const Crossing& c : crossings) {
      const double share =
          whole > 0 ? (c.ends[1] - c.ends[0]).norm() / whole : 1 / static_cast<double>(crossings.size());
      out += share / 2 * (c.ends[0] + c.ends[1]);
    }
    return out;
  }
  /// Number of parts that do not touch, and of points in which crossings meet.
  std::pair<std::size_t, std::size_t> parts_and_points() const {
    std::vector<Edge> points;
    for (const Crossing& c : crossings) points.insert(points.end(), c.edges.begin(), c.edges.end());
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const auto index = [&](const Edge& e) {
      return static_cast<int>(std::ranges::lower_bound(points, e) - points.begin());
    };
    DisjointSets sets(points.size());
    for (const Crossing& c : crossings) sets.join(index(c.edges[0]), index(c.edges[1]));
    std::size_t parts = 0;
    for (int i = 0; i < static_cast<int>(points.size()); ++i) parts += sets.root(i) == i ? 1 : 0;
    return {parts, points.size()};
  }
};

double way_of_slice(int k, int slices) {
  return (k + 0.5) / slices;
}

std::vector<Slice> cut(std::span<const Vec3> x, std::span<const Triangle> triangles, std::span<const double> ways,
                       int slices) {
  std::vector<Slice> out(at(slices));
  for (const Triangle& t : triangles) {
    const auto [lo, hi] = std::minmax({ways[at(t[0])], ways[at(t[1])], ways[at(t[2])]});
    const int first = std::max(0, static_cast<int>(std::floor(lo * slices - 0.5)));
    const int last = std::min(slices - 1, static_cast<int>(std::ceil(hi * slices - 0.5)));
    for (int k = first; k <= last; ++k) {
      const double way = way_of_slice(k, slices);
      Crossing c;
      std::size_t count = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const int a = std::min(t[i], t[(i + 1) % 3]), b = std::max(t[i], t[(i + 1) % 3]);
        if ((ways[at(a)] < way) == (ways[at(b)] < way)) continue;
        const double share = (way - ways[at(a)]) / (ways[at(b)] - ways[at(a)]);
        c.edges[count] = {a, b};
        c.ends[count++] = (1 - share) * x[at(a)] + share * x[at(b)];
      }
      if (count == 2) out[at(k)].crossings.push_back(c);
    }
  }
  return out;
}

/// Where a line ends that is led on beyond its last slice: in the direction of its last few slices, as far as the
/// vertices there lie in the mean.
Vec3 led_on(std::span<const Vec3> from_end, std::span<const Vec3> x, std::span<const double> ways, double from,
            double to) {
  const Vec3& end = from_end.front();
  const Vec3 outwards = (end - from_end[std::min(k_slices_of_direction, from_end.size() - 1)]).normalized();
  std::vector<double> beyond;
  for (std::size_t v = 0; v < x.size(); ++v)
    if (ways[v] >= from && ways[v] <= to) beyond.push_back(outwards.dot(x[v] - end));
  const double most = beyond.empty() ? 0 : std::max(0.0, *std::ranges::max_element(beyond));
  double sum = 0;
  int count = 0;
  for (const double b : beyond)
    if (b > most / 2) sum += b, ++count;
  return end + (count > 0 ? sum / count : 0) * outwards;
}

}  // namespace

MiddleLine middle_line(std::span<const Vec3> positions, std::span<const Triangle> triangles,
                       std::span<const double> ways, int slices) {
  const auto all = cut(positions, triangles, ways, slices);
  std::vector<double> lengths;
  for (const Slice& slice : all) lengths.push_back(slice.length());
  const Range whole = whole_slices(lengths);
  MiddleLine out;
  double singles = 0, closed = 0, sum = 0;
  for (std::size_t k = whole.first; k <= whole.last; ++k) {
    if (all[k].crossings.empty()) continue;
    out.line.push_back(all[k].centre());
    out.ways.push_back(way_of_slice(static_cast<int>(k), slices));
    const auto [parts, points] = all[k].parts_and_points();
    const bool closes = points <= all[k].crossings.size();
    singles += parts == 1 ? 1 : 0, closed += closes ? 1 : 0;
    sum += lengths[k] / (closes ? std::numbers::pi : 1);
  }
  if (out.line.size() < 2) return {};
  const auto count = static_cast<double>(out.line.size());
  out.breadth = sum / count, out.single_share = singles / count, out.closed_share = closed / count;
  const std::vector<Vec3> backwards(out.line.rbegin(), out.line.rend());
  const Vec3 start = led_on(out.line, positions, ways, 0, out.ways.front());
  const Vec3 end = led_on(backwards, positions, ways, out.ways.back(), 1);
  out.line.insert(out.line.begin(), start), out.ways.insert(out.ways.begin(), 0.0);
  out.line.push_back(end), out.ways.push_back(1.0);
  return out;
}

}  // namespace ft::inline io

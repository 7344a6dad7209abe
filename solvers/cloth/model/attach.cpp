#include "solvers/cloth/model/attach.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "baker/core/parallel.h"
#include "solvers/cloth/model/cloth_model.h"
#include "solvers/cloth/model/sewing.h"

namespace ft::inline solvers {
namespace {

/// What is farther than this many times its distance along the cloth is another side of it. On one side the way along
/// the edges is up to half as long again.
constexpr double k_other_side = 3;

/// Ways along the edges of a mesh.
class EdgeWays {
 public:
  EdgeWays(std::span<const Vec3> x, std::span<const Triangle> triangles) : rows_(x.size()) {
    const RestEdges rest = rest_edges(x, triangles);
    for (std::size_t i = 0; i < rest.edges.size(); ++i) {
      const auto [a, b] = rest.edges[i];
      rows_[at(a)].emplace_back(rest.lengths[i], b);
      rows_[at(b)].emplace_back(rest.lengths[i], a);
    }
  }
  /// Length of the shortest way from a vertex to each [m]; 0 to its neighbours, too: what touches them is the same
  /// side, whatever the shape of the triangles.
  std::vector<double> from(int vertex) const {
    std::vector<double> way(rows_.size(), std::numeric_limits<double>::infinity());
    std::priority_queue<Step, std::vector<Step>, std::greater<>> next;
    next.emplace(way[at(vertex)] = 0, vertex);
    while (!next.empty()) {
      const auto [length, v] = next.top();
      next.pop();
      if (length > way[at(v)]) continue;
      for (const auto& [edge, w] : rows_[at(v)])
        if (length + edge < way[at(w)]) next.emplace(way[at(w)] = length + edge, w);
    }
    for (const auto& [edge, w] : rows_[at(vertex)]) way[at(w)] = 0;
    return way;
  }

 private:
  using Step = std::pair<double, int>;  ///< m, to
  std::vector<std::vector<Step>> rows_;
};

}  // namespace

std::vector<SurfacePoint> anchor_points(std::span<const ClothGarment> garments, std::size_t own, const ClothPin& pin) {
  const std::vector<Vec3>& y = garments[at(pin.to)].mesh.positions;
  const std::vector<Triangle> triangles = triangulate(garments[at(pin.to)].mesh);
  const bool same = at(pin.to) == own;
  const EdgeWays ways = same ? EdgeWays(y, triangles) : EdgeWays({}, {});
  std::vector<SurfacePoint> out(pin.vertices.size());
  parallel_for(out.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3& place = garments[own].mesh.positions[at(pin.vertices[i])];
      const std::vector<double> way = same ? ways.from(pin.vertices[i]) : std::vector<double>();
      out[i] = nearest_point(place, y, triangles, [&](const Triangle& t, double distance) {
        return !same || std::min({way[at(t[0])], way[at(t[1])], way[at(t[2])]}) > k_other_side * distance;
      });
    }
  });
  return out;
}

std::vector<HoldSpan> hold_spans(const ClothPin& pin, std::span<const Vec3> rest) {
  std::vector<HoldSpan> out(pin.vertices.size(), pin.hold);
  if (pin.opens.isZero() || out.empty()) return out;
  std::vector<double> place;
  for (const int v : pin.vertices) place.push_back(pin.opens.dot(rest[at(v)]));
  const auto [first, last] = std::minmax_element(place.begin(), place.end());
  const double length = *last - *first, own = pin.hold.fade / static_cast<double>(out.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double share = length > 0 ? (place[i] - *first) / length : 0;
    out[i].from += (1 - share) * (pin.hold.fade - own);
    out[i].until += share * (pin.hold.fade - own);
    out[i].fade = own;
  }
  return out;
}

void attach(ClothModel& model) {
  const std::vector<double> length = seam_lengths(*model.topology);
  const auto radius = [&](int v) { return ContactModel::self_radius(model.contact.radius[at(v)]); };
  const AttachSettings settings;
  for (std::size_t g = 0; g < model.setup.garments.size(); ++g)
    for (const ClothPin& pin : model.setup.garments[g].pins) {
      if (pin.to < 0) continue;
      const std::vector<SurfacePoint> held = anchor_points(model.setup.garments, g, pin);
      const std::vector<HoldSpan> holds = hold_spans(pin, model.setup.garments[g].mesh.positions);
      for (std::size_t k = 0; k < held.size(); ++k) {
        AttachPoint point;
        point.vertex = model.first_vertex[g] + pin.vertices[k];
        const double weight = pin.weights.empty() ? 1.0 : pin.weights[k];
        if (held[k].triangle[0] < 0 || weight <= 0 || model.unused[at(point.vertex)]) continue;
        double touching = 0;
        for (std::size_t c = 0; c < 3; ++c) {
          point.triangle[c] = model.first_vertex[at(pin.to)] + held[k].triangle[c];
          touching += held[k].weight[c] * radius(point.triangle[c]);
        }
        point.weight = held[k].weight;
        point.length = held[k].distance;
        // Contact keeps two garments so far apart; what is near at rest within one it leaves there.
        if (at(pin.to) != g) point.length = std::max(point.length, std::min(touching, radius(point.vertex)));
        point.stiffness = weight * settings.stiffness * length[at(point.vertex)];
        point.max_pull = weight * settings.hold * length[at(point.vertex)];
        point.hold = holds[k];
        model.topology->attachments.push_back(point);
      }
    }
}

}  // namespace ft::inline solvers

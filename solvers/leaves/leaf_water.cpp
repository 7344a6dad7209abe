#include "solvers/leaves/leaf_water.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace ft::inline solvers {
namespace {

/// By which a vertex may be beside its place on the grid, of a cell [1].
constexpr double k_beside = 1e-3;

/// Between two vertices of a row that are known: straight. first: the first one that is not; end: behind the last.
void bridge(std::span<double> row, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    const double t = static_cast<double>(i + 1 - first) / static_cast<double>(end + 1 - first);
    row[i] = first == 0 ? row[end] : end == row.size() ? row[first - 1] : (1 - t) * row[first - 1] + t * row[end];
  }
}

}  // namespace

std::optional<LeafWaters::Water> LeafWaters::grid_of(const LeafWater& water) {
  const std::vector<Vec3> x = bind_pose_of(*water.surface);
  Water out;
  out.setup = &water;
  if (x.size() < 4) return {};
  std::size_t row = 1;
  while (row < x.size() && std::abs(x[row].z() - x[0].z()) < k_beside * std::abs(x[1].x() - x[0].x())) ++row;
  if (row < 2 || row == x.size() || x.size() % row != 0) return {};
  out.nx = static_cast<int>(row), out.nz = static_cast<int>(x.size() / row);
  out.origin = Vec2(x[0].x(), x[0].z());
  out.cell = (Vec2(x.back().x(), x.back().z()) - out.origin).cwiseQuotient(Vec2(out.nx - 1, out.nz - 1));
  if (!(out.cell.x() > 0) || !(out.cell.y() > 0)) return {};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec2 wanted =
        out.origin + Vec2(static_cast<double>(i % row), static_cast<double>(i / row)).cwiseProduct(out.cell);
    if (!((Vec2(x[i].x(), x[i].z()) - wanted).norm() < k_beside * out.cell.minCoeff())) return {};
  }
  return out;
}

std::string LeafWaters::fault_of(const LeafWater& water) {
  if (grid_of(water)) return {};
  return "\"" + water.name + "\" is no surface to float on: its vertices are no grid over x and z";
}

LeafWaters::LeafWaters(std::span<const LeafWater> waters) {
  for (const LeafWater& water : waters)
    if (auto grid = grid_of(water)) waters_.push_back(std::move(*grid));
}

std::vector<double> LeafWaters::Water::heights_at(double time, std::vector<Vec3>& places) const {
  setup->surface->sample(time, places);
  std::vector<double> out(places.size());
  for (std::size_t k = 0; k < at(nz); ++k) {
    const std::span<double> row = std::span(out).subspan(k * at(nx), at(nx));
    std::size_t known = 0;  // behind the last vertex that is above its place
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Vec3& p = places[k * at(nx) + i];
      const Vec2 wanted = origin + Vec2(static_cast<double>(i), static_cast<double>(k)).cwiseProduct(cell);
      row[i] = p.y();
      if (!((Vec2(p.x(), p.z()) - wanted).norm() < k_beside * cell.minCoeff())) continue;
      bridge(row, known, i);
      known = i + 1;
    }
    if (known > 0) bridge(row, known, row.size());
  }
  return out;
}

double LeafWaters::Water::outside(const Vec3& place) const {
  const Vec2 p = Vec2(place.x(), place.z()) - origin, size = cell.cwiseProduct(Vec2(nx - 1, nz - 1));
  return (p - p.cwiseMax(Vec2::Zero()).cwiseMin(size)).norm();
}

void LeafWaters::begin_frame(double t0, double t1) {
  constexpr std::size_t last = LeafBodies::k_slices;
  const double step = (t1 - t0) / static_cast<double>(last);
  std::vector<Vec3> places;
  for (Water& w : waters_) {
    places.resize(at(w.nx) * at(w.nz));
    const std::vector<double> before = w.heights_at(t0 - step, places);
    for (std::size_t k = 0; k <= last; ++k) w.height[k] = w.heights_at(t0 + step * static_cast<double>(k), places);
    // Central differences; at the end one-sided of the same order, so that a frame hangs on nothing after it.
    for (std::size_t k = 0; k <= last; ++k) {
      w.rise[k].resize(before.size());
      for (std::size_t i = 0; i < before.size(); ++i)
        w.rise[k][i] = k < last ? (w.height[k + 1][i] - (k > 0 ? w.height[k - 1][i] : before[i])) / (2 * step)
                                : (3 * w.height[k][i] - 4 * w.height[k - 1][i] + w.height[k - 2][i]) / (2 * step);
    }
    for (std::size_t end = 0; end < 2; ++end) {
      w.flow[end].assign(before.size(), Vec3::Zero());
      if (w.setup->flow) w.setup->flow->sample(end == 0 ? t0 : t1, w.flow[end]);
    }
  }
}

std::optional<WaterPatch> LeafWaters::under(const Vec3& place, double radius, int slice, double share,
                                            bool floats) const {
  const Water* w = nullptr;
  double nearest = 0;
  for (const Water& one : waters_) {
    const double outside = one.outside(place);
    if ((outside > 0 && !floats) || (w && outside >= nearest)) continue;
    w = &one, nearest = outside;
  }
  if (!w) return {};
  const auto k = at(slice);
  const double through = (slice + share) / LeafBodies::k_slices;
  struct Here {
    double height, rise;
    Vec3 flow;
  };
  const auto look = [&](double x, double z) {
    const double s = std::clamp((x - w->origin.x()) / w->cell.x(), 0.0, static_cast<double>(w->nx - 1)),
                 t = std::clamp((z - w->origin.y()) / w->cell.y(), 0.0, static_cast<double>(w->nz - 1));
    const int i = std::min(static_cast<int>(s), w->nx - 2), j = std::min(static_cast<int>(t), w->nz - 2);
    const double a = s - i, b = t - j;
    Here out{0, 0, Vec3::Zero()};
    for (const auto& [di, dj, weight] : {std::tuple(0, 0, (1 - a) * (1 - b)), std::tuple(1, 0, a * (1 - b)),
                                         std::tuple(0, 1, (1 - a) * b), std::tuple(1, 1, a * b)}) {
      const std::size_t v = at(j + dj) * at(w->nx) + at(i + di);
      out.height += weight * ((1 - share) * w->height[k][v] + share * w->height[k + 1][v]);
      out.rise += weight * ((1 - share) * w->rise[k][v] + share * w->rise[k + 1][v]);
      out.flow += weight * ((1 - through) * w->flow[0][v] + through * w->flow[1][v]);
    }
    return out;
  };
  const Here east = look(place.x() + radius, place.z()), west = look(place.x() - radius, place.z()),
             south = look(place.x(), place.z() + radius), north = look(place.x(), place.z() - radius);
  WaterPatch out;
  out.level = 0.25 * (east.height + west.height + south.height + north.height);
  out.slope = Vec2(east.height - west.height, south.height - north.height) / (2 * radius);
  out.flow = 0.25 * (east.flow + west.flow + south.flow + north.flow);
  out.flow.y() = 0.25 * (east.rise + west.rise + south.rise + north.rise);
  const Vec3 up(-out.slope.x(), 1, -out.slope.y());
  out.normal = up.normalized();
  const Vec3 steeper = Vec3(west.rise - east.rise, 0, north.rise - south.rise) / (2 * radius);
  const double about = 0.5 * ((south.flow.x() - north.flow.x()) - (east.flow.z() - west.flow.z())) / (2 * radius);
  out.turning = up.cross(steeper) / up.squaredNorm() + about * out.normal;
  return out;
}

}  // namespace ft::inline solvers

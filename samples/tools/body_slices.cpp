#include "samples/tools/body_slices.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "collision/check/checked_surface.h"
#include "collision/geometry/winding_number.h"

namespace ft::garments {
namespace {

constexpr double k_cell = 5e-3;  // m; a wrist is ten cells wide
/// Times the waist: no chest is so wide, a trunk with its arms is.
constexpr double k_arms = 2;

/// The cells of one slice; 0 outside, otherwise the number of the connected piece.
struct Cells {
  int columns = 0, rows = 0;
  Vec2 origin = Vec2::Zero();
  std::vector<int> piece;
  std::vector<int> piece_size;  ///< index 0 unused
  Vec2 centre(int cell) const { return origin + k_cell * Vec2(cell % columns + 0.5, cell / columns + 0.5); }
};

void number_pieces(Cells& cells) {
  cells.piece_size.assign(1, 0);
  std::vector<int> stack;
  for (int start = 0; start < cells.columns * cells.rows; ++start) {
    if (cells.piece[at(start)] != -1) continue;
    const int number = static_cast<int>(cells.piece_size.size());
    cells.piece_size.push_back(0);
    cells.piece[at(start)] = number;
    stack.assign(1, start);
    while (!stack.empty()) {
      const int cell = stack.back();
      stack.pop_back();
      ++cells.piece_size[at(number)];
      const int x = cell % cells.columns, z = cell / cells.columns;
      const auto visit = [&](int nx, int nz) {
        if (nx < 0 || nz < 0 || nx >= cells.columns || nz >= cells.rows) return;
        int& other = cells.piece[at(nz * cells.columns + nx)];
        if (other != -1) return;
        other = number;
        stack.push_back(nz * cells.columns + nx);
      };
      visit(x - 1, z), visit(x + 1, z), visit(x, z - 1), visit(x, z + 1);
    }
  }
}

/// Fills the rows of the plane y = height between the surface's crossings. winding_tree: of a body that is not closed,
/// whose crossings do not tell.
Cells slice_cells(const Body& body, std::span<const int> candidates, double height, const Box& bounds,
                  const WindingTree* winding_tree) {
  Cells cells;
  cells.origin = Vec2(bounds.lo.x() - 2 * k_cell, bounds.lo.z() - 2 * k_cell);
  cells.columns = static_cast<int>(std::ceil(bounds.size().x() / k_cell)) + 4;
  cells.rows = static_cast<int>(std::ceil(bounds.size().z() / k_cell)) + 4;
  cells.piece.assign(at(cells.columns * cells.rows), 0);
  std::vector<std::vector<std::pair<double, int>>> crossings(at(cells.rows));
  for (const int index : candidates) {
    const Triangle& t = body.triangles[at(index)];
    Vec2 ends[2];
    int count = 0;
    for (int k = 0; k < 3 && count < 2; ++k) {
      const Vec3 &p = body.positions[at(t[at(k)])], &q = body.positions[at(t[at((k + 1) % 3)])];
      if ((p.y() < height) == (q.y() < height)) continue;
      const double s = (height - p.y()) / (q.y() - p.y());
      ends[count++] = Vec2(p.x() + s * (q.x() - p.x()), p.z() + s * (q.z() - p.z()));
    }
    if (count < 2) continue;
    const Vec3 normal = (body.positions[at(t[1])] - body.positions[at(t[0])])
                            .cross(body.positions[at(t[2])] - body.positions[at(t[0])]);
    const int sign = normal.x() > 0 ? 1 : -1;
    if (ends[0].y() > ends[1].y()) std::swap(ends[0], ends[1]);
    const int first = std::max(0, static_cast<int>(std::ceil((ends[0].y() - cells.origin.y()) / k_cell - 0.5)));
    for (int row = first; row < cells.rows; ++row) {
      const double z = cells.origin.y() + (row + 0.5) * k_cell;
      if (z < ends[0].y()) continue;
      if (z >= ends[1].y()) break;
      const double s = (z - ends[0].y()) / (ends[1].y() - ends[0].y());
      crossings[at(row)].emplace_back(ends[0].x() + s * (ends[1].x() - ends[0].x()), sign);
    }
  }
  for (int row = 0; row < cells.rows; ++row) {
    auto& line = crossings[at(row)];
    std::sort(line.begin(), line.end());
    int winding = 0;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      winding -= line[k].second;  // entering the body, the normal points back along the row
      const Vec3 middle(0.5 * (line[k].first + line[k + 1].first), height, cells.origin.y() + (row + 0.5) * k_cell);
      if (winding_tree != nullptr ? !winding_tree->is_inside(middle) : winding == 0) continue;
      const int from = static_cast<int>(std::ceil((line[k].first - cells.origin.x()) / k_cell - 0.5));
      const int to = static_cast<int>(std::ceil((line[k + 1].first - cells.origin.x()) / k_cell - 0.5));
      for (int column = std::max(0, from); column < std::min(to, cells.columns); ++column)
        cells.piece[at(row * cells.columns + column)] = -1;
    }
  }
  number_pieces(cells);
  return cells;
}

/// Keeps the pieces in `kept`, and what the tailor wants to know about them.
Slice describe(const Cells& cells, const std::vector<bool>& kept, double height) {
  Slice slice;
  slice.height = height;
  std::vector<Vec2> points;
  double lo = std::numeric_limits<double>::infinity(), hi = -lo;
  for (int cell = 0; cell < cells.columns * cells.rows; ++cell) {
    const Vec2 p = cells.centre(cell);
    if (!kept[at(cells.piece[at(cell)])]) {
      if (cells.piece[at(cell)] > 0) slice.beside.push_back(p);
      continue;
    }
    slice.centre += p;
    slice.area += k_cell * k_cell;
    lo = std::min(lo, p.x()), hi = std::max(hi, p.x());
    points.push_back(p);
  }
  slice.component_count = static_cast<int>(std::count(kept.begin(), kept.end(), true));
  if (points.empty()) return slice;
  slice.centre /= static_cast<double>(points.size());
  slice.width_x = hi - lo + k_cell;
  slice.outline = convex_hull(std::move(points));
  return slice;
}

/// The pieces of `cells` that lie over (or under) what was kept of the neighbouring slice.
std::vector<bool> follow(const Cells& cells, const Cells& neighbour, const std::vector<bool>& neighbour_kept) {
  std::vector<int> shared(cells.piece_size.size(), 0);
  for (std::size_t cell = 0; cell < cells.piece.size(); ++cell)
    if (cells.piece[cell] > 0 && neighbour_kept[at(neighbour.piece[cell])]) ++shared[at(cells.piece[cell])];
  std::vector<bool> kept(cells.piece_size.size(), false);
  for (std::size_t k = 1; k < kept.size(); ++k) kept[k] = shared[k] > 0 && cells.piece_size[k] >= 12;
  return kept;
}

}  // namespace

std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
  std::sort(points.begin(), points.end(),
            [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  const auto turn = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
  };
  if (points.size() < 3) return points;
  std::vector<Vec2> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t base = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= base + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

double hull_distance(std::span<const Vec2> hull, const Vec2& from, const Vec2& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Vec2 edge = hull[(k + 1) % hull.size()] - hull[k];
    const Vec2 outward(edge.y(), -edge.x());
    const double room = outward.dot(hull[k] - from), speed = outward.dot(direction);
    if (room < 0) return 0;
    if (speed > 1e-12) nearest = std::min(nearest, room / speed);
  }
  return std::isfinite(nearest) ? nearest : 0;
}

const Slice& BodyShape::slice_at(double height) const {
  const int index = static_cast<int>(std::lround((height - slices.front().height) / spacing));
  return slices[at(std::clamp(index, 0, static_cast<int>(slices.size()) - 1))];
}

Eigen::Isometry3d arms_along_x(const Body& body) {
  Box box = bounds(body.positions);
  const double chest = box.lo.y() + 0.6 * box.size().y();
  // Area-weighted, so that finely meshed hands do not count for more than they are.
  double weight = 0;
  Vec2 mean = Vec2::Zero();
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Triangle& t : body.triangles) {
    const Vec3 &a = body.positions[at(t[0])], &b = body.positions[at(t[1])], &c = body.positions[at(t[2])];
    const Vec3 middle = (a + b + c) / 3;
    if (middle.y() < chest) continue;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Vec2 p(middle.x(), middle.z());
    weight += area;
    mean += area * p;
    moment += area * p * p.transpose();
  }
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  if (weight <= 0) return turn;
  mean /= weight;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(moment / weight - mean * mean.transpose());
  if (axes.eigenvalues()[1] < 1.5 * axes.eigenvalues()[0]) return turn;
  Vec2 side = axes.eigenvectors().col(1);
  if (std::abs(side.x()) > std::abs(side.y()) ? side.x() < 0 : side.y() < 0) side = -side;
  // Already along x to a few degrees: leave the body as it is, most are exactly aligned.
  if (std::abs(side.y()) < 0.1) return turn;
  turn.linear() = Eigen::AngleAxisd(std::atan2(side.y(), side.x()), Vec3::UnitY()).toRotationMatrix();
  return turn;
}

Result<BodyShape> measure_body(const Body& body, double waist) {
  BodyShape shape;
  shape.bounds = bounds(body.positions);
  const double height = shape.bounds.size().y();
  if (!(height > 0.1 && height < 10)) return input_error("the body is not between 0.1 and 10 m tall");
  shape.spacing = height / 350;
  const int count = 349;
  std::vector<std::vector<int>> candidates(at(count));
  const auto slice_height = [&](int k) { return shape.bounds.lo.y() + (k + 1) * shape.spacing; };
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
    Box box;
    for (const int v : body.triangles[at(t)]) box.include(body.positions[at(v)]);
    const int first = std::max(0, static_cast<int>(std::floor((box.lo.y() - shape.bounds.lo.y()) / shape.spacing)) - 1);
    for (int k = first; k < count && slice_height(k) <= box.hi.y(); ++k)
      if (slice_height(k) >= box.lo.y()) candidates[at(k)].push_back(t);
  }
  CheckedSurface surface(body.triangles);
  surface.move(body.positions);
  std::optional<WindingTree> winding;
  if (!surface.closed()) winding.emplace(surface.tree(), body.positions, body.triangles);
  std::vector<Cells> cells(at(count));
  for (int k = 0; k < count; ++k)
    cells[at(k)] = slice_cells(body, candidates[at(k)], slice_height(k), shape.bounds, winding ? &*winding : nullptr);

  // The waist: the narrowest of the torso slices, the torso being the largest piece there.
  const auto largest = [&](int k) {
    const auto& sizes = cells[at(k)].piece_size;
    return static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  };
  // Shares of the height of somebody whose neck is at 0.86 of it; of a large head, the body below counts.
  const auto largest_size = [&](int k) { return cells[at(k)].piece_size[at(largest(k))]; };
  double whole = 350;
  const auto index_of = [&](double share) { return std::clamp(static_cast<int>(share * whole) - 1, 0, count - 1); };
  int throat = index_of(0.52);
  for (int k = throat; k <= index_of(0.92); ++k)
    if (largest_size(k) < largest_size(throat)) throat = k;
  if (throat < index_of(0.75)) whole = (throat + 1) / 0.86;
  shape.figure_height = whole * shape.spacing;
  int waist_index = std::clamp(static_cast<int>(waist * 350) - 1, 0, count - 1);
  if (waist <= 0) {
    waist_index = index_of(0.55);
    for (int k = index_of(0.55); k <= index_of(0.68); ++k)
      if (largest_size(k) < largest_size(waist_index)) waist_index = k;
  }
  if (largest_size(waist_index) == 0)
    return input_error("no closed cross-section at the height of the waist: is this a standing body with Y up?");

  std::vector<std::vector<bool>> kept(at(count));
  kept[at(waist_index)].assign(cells[at(waist_index)].piece_size.size(), false);
  kept[at(waist_index)][at(largest(waist_index))] = true;
  for (int k = waist_index - 1; k >= 0; --k) kept[at(k)] = follow(cells[at(k)], cells[at(k + 1)], kept[at(k + 1)]);
  for (int k = waist_index + 1; k < count; ++k) kept[at(k)] = follow(cells[at(k)], cells[at(k - 1)], kept[at(k - 1)]);
  for (int k = 0; k < count; ++k) shape.slices.push_back(describe(cells[at(k)], kept[at(k)], slice_height(k)));

  shape.waist = slice_height(waist_index);
  shape.waist_centre = shape.slices[at(waist_index)].centre;
  shape.crotch = shape.bounds.lo.y();
  for (int k = waist_index; k >= 0; --k)
    if (shape.slices[at(k)].component_count != 1) {
      shape.crotch = slice_height(k);
      break;
    }
  int neck_index = index_of(0.80);
  for (int k = neck_index; k <= index_of(0.92); ++k)
    if (shape.slices[at(k)].area < shape.slices[at(neck_index)].area) neck_index = k;
  shape.neck = slice_height(neck_index);
  const double neck_width = shape.slices[at(neck_index)].width_x;
  int base = neck_index;
  while (base > waist_index + 1 && shape.slices[at(base)].width_x < 1.4 * neck_width) --base;
  shape.neck_base = slice_height(base);
  // Where arms leave the trunk below the chest, it is as wide as it was under them.
  double chest = shape.slice_at(shape.waist).width_x;
  const double widest = k_arms * chest;
  for (const Slice& slice : shape.slices)
    if (slice.height > shape.waist && slice.height <= shape.waist + 0.45 * (shape.neck_base - shape.waist)) {
      if (slice.width_x > widest) break;
      chest = slice.width_x;
    }
  shape.chest_half_width = 0.5 * chest;
  return shape;
}

}  // namespace ft::garments

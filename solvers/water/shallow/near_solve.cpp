// Heads near bodies, and the velocities of those that float. See near_water.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "solvers/water/shallow/near_water.h"

namespace ft::inline solvers {
namespace {

constexpr int k_most_newton = 40, k_most_halvings = 12;
/// The first changes are made whole: mostly that ends at once in the right pieces of V, and a change that is cut for
/// one cell's sake keeps all others waiting.
constexpr int k_whole_changes = 12;
/// How much of its slope the energy may have left along a change [1].
constexpr double k_turned = 0.5;
/// Of thicknesses: absolute [m], and as a share of what was wrong at first.
constexpr double k_tolerance = 1e-11, k_relative = 1e-6;
/// Put on the diagonal, where a body lies on the ground and what is left can go nowhere.
constexpr double k_stiff = 1e-6;

}  // namespace

Vec6 NearWater::lever(const Vec3& way, const Vec3& place, const Vec3& about) {
  Vec6 out;
  out.head<3>() = way;
  out.tail<3>() = (place - about).cross(way);
  return out;
}

void NearWater::couple(Flow& f, const NearLaws& laws, double dt) {
  const double by_cell = dt / f.cell, factor = laws.gravity * by_cell * by_cell;
  const std::size_t n = cells_.size();
  depth_.assign(n, {});
  system_.neighbour.resize(n);
  system_.coupling.resize(n);
  for (std::size_t m = 0; m < n; ++m) {
    Cell& cell = cells_[m];
    system_.neighbour[m] = {index(cell.i - 1, cell.k), index(cell.i + 1, cell.k), index(cell.i, cell.k - 1),
                            index(cell.i, cell.k + 1)};
    cell.aim = f.h[cell.c];
    for (std::size_t side = 0; side < 4; ++side) {
      const bool along_x = side < 2, high = side % 2 == 1;
      const std::size_t step = along_x ? 1 : f.row, face = cell.c + (high ? step : 0);
      const bool edge = along_x ? (high ? cell.i + 1 == f.nx : cell.i == 0) : (high ? cell.k + 1 == f.nz : cell.k == 0);
      std::vector<double>&v1 = along_x ? f.u1 : f.w1, &q1 = along_x ? f.qx1 : f.qz1;
      const int other = system_.neighbour[m][side];
      double& depth = depth_[m][side];
      if (!edge) {
        const bool done = !high && other >= 0;  // the neighbour has written it
        const bool bare = cell.begin == cell.end && (other < 0 || cells_[at(other)].begin == cells_[at(other)].end);
        if (done) {
          depth = depth_[at(other)][side + 1];
        } else if (bare) {
          depth = face_depth(f, face, along_x, v1[face]);
        } else {
          // From where it flows, or would for the heads, as much as there is room for on the other side.
          const std::size_t beyond = high ? cell.c + step : cell.c - step;
          const double head = cell.head0, head_beyond = f.bed[beyond] + f.h[beyond] + f.lift[beyond];
          const double level = f.bed[cell.c] + f.h[cell.c], level_beyond = f.bed[beyond] + f.h[beyond];
          const double room = f.bed[cell.c] + cell.capacity;
          const double room_beyond =
              f.bed[beyond] + (other >= 0 ? cells_[at(other)].capacity : std::numeric_limits<double>::infinity());
          double outwards = high ? v1[face] : -v1[face];
          if (outwards == 0) outwards = head - head_beyond;
          double surface = std::min(level, level_beyond);
          if (outwards > 0) surface = std::min(level, room_beyond);
          if (outwards < 0) surface = std::min(level_beyond, room);
          depth = std::max(0.0, surface - (along_x ? f.bed_x : f.bed_z)[face]);
        }
        if (!done) {
          const std::vector<double>& v = along_x ? f.u : f.w;
          if (depth <= k_dry) {
            depth = v1[face] = 0;
          } else if (v1[face] == 0 && !bare) {
            const std::size_t low = face - step;
            v1[face] = v[face] - laws.gravity * by_cell *
                                     ((f.bed[face] + f.h[face] + f.lift[face]) - (f.bed[low] + f.h[low] + f.lift[low]));
          }
          q1[face] = v1[face] * depth;
        }
      }
      system_.coupling[m][side] = factor * depth;
      cell.aim -= by_cell * (high ? q1[face] : -q1[face]);
    }
  }
}

double NearWater::evaluate(std::span<const NearBody> bodies, const NearLaws& laws, double dt, double cell_size) {
  const double weight = laws.density * laws.gravity * cell_size * cell_size / k_columns_a_cell;
  force_.assign(bodies.size(), Vec6::Zero());
  std::vector<Vec6> moved(bodies.size(), Vec6::Zero());
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].floats) moved[b] = dt * (bodies[b].velocity - bodies[b].posed);
  double merit = 0;
  residual = 0;
  for (std::size_t n = 0; n < cells_.size(); ++n) {
    Cell& cell = cells_[n];
    double taken = 0;
    int wet = 0, over = 0;
    for (int s = cell.begin; s < cell.end; ++s) {
      const Reach& r = reaches_[at(s)];
      const std::size_t low = at(r.bottom_body), high = at(r.top_body);
      double p = cell.head - r.bottom, q = cell.head - r.top;
      // Levers matter for bodies that answer.
      if (bodies[low].floats) {
        const Vec6 below = lever(r.bottom_way, r.bottom_place, bodies[low].about);
        p -= below.dot(moved[low]);
        if (p > 0) force_[low] += weight * p * below;
      }
      if (bodies[high].floats && std::isfinite(r.top)) {
        const Vec6 above = lever(r.top_way, r.top_place, bodies[high].about);
        q -= above.dot(moved[high]);
        if (q > 0) force_[high] -= weight * q * above;
      }
      if (p > 0) taken += p, ++wet;
      if (q > 0) taken -= q, ++over;
    }
    const double bed = bed_[n];
    cell.volume = cell.head - bed - taken / k_columns_a_cell;
    cell.slope = 1 - static_cast<double>(wet - over) / k_columns_a_cell;
    cell.covered = static_cast<double>(wet - over) / k_columns_a_cell;
    double r = cell.volume - cell.aim;
    const double d = cell.head - cell.head0;
    for (std::size_t side = 0; side < 4; ++side) {
      const int j = system_.neighbour[n][side];
      r += system_.coupling[n][side] * (d - (j >= 0 ? cells_[at(j)].head - cells_[at(j)].head0 : 0.0));
    }
    rest_[n] = r;
    merit += r * r;
    residual = std::max(residual, std::abs(r));
  }
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].floats) continue;
    const NearBody& body = bodies[b];
    const Vec6 off = dt * (body.velocity - body.free) - dt * dt * body.mass.ldlt().solve(force_[b] + body.rest_force);
    merit += off.squaredNorm();
    residual = std::max(residual, off.cwiseAbs().maxCoeff());
  }
  return merit;
}

void NearWater::assemble(std::span<const NearBody> bodies, const NearLaws& laws, double dt, double cell_size) {
  const std::size_t n = cells_.size();
  const double weight = laws.density * laws.gravity * cell_size * cell_size;
  system_.diagonal.resize(n);
  system_.bodies.assign(bodies.size(), {});
  std::vector<Mat6> stiffness(bodies.size(), Mat6::Zero());
  for (std::size_t m = 0; m < n; ++m) {
    const Cell& cell = cells_[m];
    const auto& c = system_.coupling[m];
    system_.diagonal[m] = std::max(cell.slope, 0.0) + c[0] + c[1] + c[2] + c[3] + k_stiff;
    const auto direction = [&](int body) -> Vec6& {
      NearSystem::Body& b = system_.bodies[at(body)];
      if (b.rows.empty() || b.rows.back() != static_cast<int>(m)) {
        b.rows.push_back(static_cast<int>(m));
        b.directions.push_back(Vec6::Zero());
      }
      return b.directions.back();
    };
    for (int s = cell.begin; s < cell.end; ++s) {
      const Reach& r = reaches_[at(s)];
      const NearBody &low = bodies[at(r.bottom_body)], &high = bodies[at(r.top_body)];
      if (low.floats) {
        const Vec6 below = lever(r.bottom_way, r.bottom_place, low.about);
        if (cell.head - r.bottom - dt * below.dot(low.velocity - low.posed) > 0) {
          direction(r.bottom_body) += below / k_columns_a_cell;
          stiffness[at(r.bottom_body)] += weight / k_columns_a_cell * below * below.transpose();
        }
      }
      if (high.floats && std::isfinite(r.top)) {
        const Vec6 above = lever(r.top_way, r.top_place, high.about);
        if (cell.head - r.top - dt * above.dot(high.velocity - high.posed) > 0)
          direction(r.top_body) -= above / k_columns_a_cell;
      }
    }
  }
  bed_.resize(n);
  std::vector<double> right(n);
  for (std::size_t m = 0; m < n; ++m) right[m] = -rest_[m];
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    NearSystem::Body& body = system_.bodies[b];
    if (!bodies[b].floats) continue;
    const Mat6 inverse = (bodies[b].mass + dt * dt * stiffness[b]).inverse();
    body.block = weight * dt * dt * inverse;
    const Vec6 wrong = bodies[b].mass * (bodies[b].velocity - bodies[b].free) - dt * (force_[b] + bodies[b].rest_force);
    const Vec6 push = dt * inverse * wrong;
    for (std::size_t r = 0; r < body.rows.size(); ++r) right[at(body.rows[r])] += body.directions[r].dot(push);
  }
  double largest = 0;
  for (const double v : right) largest = std::max(largest, std::abs(v));
  system_.solve(right, std::max(1e-13, 1e-3 * largest), delta_);
  linear_count += system_.iterations;
}

void NearWater::solve(Flow& f, std::span<NearBody> bodies, const NearLaws& laws, double dt, bool first) {
  if (cells_.empty()) {
    for (NearBody& b : bodies)
      if (b.floats) {
        b.velocity = b.free;
        b.velocity += dt * b.mass.ldlt().solve(b.rest_force);
      }
    return;
  }
  if (guess_.size() != f.size()) guess_.assign(f.size(), 0.0), guess_time_.assign(f.size(), -1);
  if (first) ++time_;
  couple(f, laws, dt);
  const std::size_t n = cells_.size();
  bed_.resize(n);
  rest_.resize(n);
  for (std::size_t m = 0; m < n; ++m) {
    bed_[m] = f.bed[cells_[m].c];
    if (!first && guess_time_[cells_[m].c] == time_) cells_[m].head = guess_[cells_[m].c];
  }
  if (first)
    for (NearBody& b : bodies) b.velocity = b.free;
  double merit = evaluate(bodies, laws, dt, f.cell);
  const double enough = std::max(k_tolerance, k_relative * residual);
  velocity_before_.resize(bodies.size());
  int newton = 0;
  for (; newton < k_most_newton && residual > enough; ++newton) {
    assemble(bodies, laws, dt, f.cell);
    before_.resize(n);
    for (std::size_t m = 0; m < n; ++m) {
      const Cell& cell = cells_[m];
      before_[m] = cell.head;
      // Where a full cell gives way again, by its cap or over a top, it takes no more than is too much.
      const double give = cell.gives + k_columns_a_cell * std::abs(rest_[m]);
      if (cell.head < cell.gives && cell.head + delta_[m] > give) delta_[m] = give - cell.head;
    }
    const double weight = laws.density * laws.gravity * f.cell * f.cell;
    std::vector<Vec6> change(bodies.size(), Vec6::Zero());
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      velocity_before_[b] = bodies[b].velocity;
      if (!bodies[b].floats) continue;
      const NearSystem::Body& body = system_.bodies[b];
      Vec6 along = Vec6::Zero();
      for (std::size_t r = 0; r < body.rows.size(); ++r) along += delta_[at(body.rows[r])] * body.directions[r];
      const Vec6 wrong =
          bodies[b].mass * (bodies[b].velocity - bodies[b].free) - dt * (force_[b] + bodies[b].rest_force);
      // block is weight dt^2 (M + dt^2 K)^-1.
      change[b] = body.block * (dt * weight * along - wrong) / (weight * dt * dt);
    }
    // Without bodies that float, R is the slope of a convex energy: along the change it must not have turned by much.
    // With them, R must become smaller.
    const bool convex = std::none_of(bodies.begin(), bodies.end(), [](const NearBody& body) { return body.floats; });
    double start_slope = 0, low = 0, high = 0;
    for (std::size_t m = 0; m < n; ++m) start_slope += rest_[m] * delta_[m];
    double step = 1;
    for (int halving = 0;; ++halving) {
      for (std::size_t m = 0; m < n; ++m) cells_[m].head = before_[m] + step * delta_[m];
      for (std::size_t b = 0; b < bodies.size(); ++b) bodies[b].velocity = velocity_before_[b] + step * change[b];
      const double now = evaluate(bodies, laws, dt, f.cell);
      double slope = 0;
      for (std::size_t m = 0; m < n; ++m) slope += rest_[m] * delta_[m];
      const bool good = newton < k_whole_changes || now < merit || residual <= enough ||
                        (convex && std::abs(slope) <= k_turned * std::abs(start_slope));
      if (good || halving == k_most_halvings) {
        merit = now;
        break;
      }
      if (!convex) {
        step *= 0.5;
      } else if (slope > 0) {
        high = step;
        step = 0.5 * (low + high);
      } else {
        low = step;
        step = high > 0 ? 0.5 * (low + high) : 2 * step;
      }
    }
  }
  newton_count += newton;
  if (residual > 1e3 * enough) ++failed_count;
  for (const Cell& cell : cells_) guess_[cell.c] = cell.head, guess_time_[cell.c] = time_;
  correct(f, laws, dt);
}

void NearWater::correct(Flow& f, const NearLaws& laws, double dt) {
  const double factor = laws.gravity * dt / f.cell, most = std::sqrt(2 * laws.gravity * laws.cap);
  for (std::size_t m = 0; m < cells_.size(); ++m) {
    const Cell& cell = cells_[m];
    const double d = cell.head - cell.head0;
    for (std::size_t side = 0; side < 4; ++side) {
      const int j = system_.neighbour[m][side];
      const bool along_x = side < 2, high = side % 2 == 1;
      if (!(depth_[m][side] > 0) || (high && j >= 0)) continue;  // the neighbour does it
      const std::size_t face = cell.c + (high ? (along_x ? 1 : f.row) : 0);
      const double beyond = j >= 0 ? cells_[at(j)].head - cells_[at(j)].head0 : 0.0;
      double& v = (along_x ? f.u1 : f.w1)[face];
      v -= factor * (high ? beyond - d : d - beyond);
      // No faster than the contact's pressure drives water: where thin films collide under a body that stands, what is
      // pressed again while it runs would go ever faster with finer cells.
      if (cell.begin != cell.end || (j >= 0 && cells_[at(j)].begin != cells_[at(j)].end))
        v = std::clamp(v, -most, most);
      (along_x ? f.qx1 : f.qz1)[face] = v * depth_[m][side];
    }
  }
}

void NearWater::keep_heads(Flow& f) const {
  for (const Cell& cell : cells_)
    if (cell.begin != cell.end) f.lift[cell.c] = cell.head - (f.bed[cell.c] + f.h[cell.c]);
}

Vec6 NearWater::force(std::size_t body, const NearBody& b, const NearLaws& laws, double cell_size,
                      const double* level) const {
  const double weight = laws.density * laws.gravity * cell_size * cell_size / k_columns_a_cell;
  Vec6 out = Vec6::Zero();
  for (const Cell& cell : cells_)
    for (int s = cell.begin; s < cell.end; ++s) {
      const Reach& r = reaches_[at(s)];
      const double head = level ? *level : cell.head;
      if (at(r.bottom_body) == body && head > r.bottom)
        out += weight * (head - r.bottom) * lever(r.bottom_way, r.bottom_place, b.about);
      if (at(r.top_body) == body && head > r.top)
        out -= weight * (head - r.top) * lever(r.top_way, r.top_place, b.about);
    }
  return out;
}

}  // namespace ft::inline solvers

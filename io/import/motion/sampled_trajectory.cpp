#include "io/import/motion/sampled_trajectory.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "baker/core/level_fit.h"
#include "baker/core/parallel.h"
#include "baker/core/rigid.h"
#include "io/import/motion/run_up.h"
#include "io/import/repair/jump_limits.h"

namespace ft::inline io {
namespace {

/// Per piece: whether it keeps its shape over the clip, as limbs of a doll do and a skin does not.
std::vector<char> rigid_pieces(const GeometryCache& cache, std::span<const int> piece_of_vertex, int count) {
  constexpr std::size_t k_times = 16, k_points = 256;
  constexpr double k_bent = 0.05;  // of its radius, both root mean square
  std::vector<std::vector<std::size_t>> vertices(at(count));
  for (std::size_t v = 0; v < piece_of_vertex.size(); ++v) vertices[at(piece_of_vertex[v])].push_back(v);
  std::vector<char> rigid(vertices.size(), 1);
  const std::size_t times = cache.times.size();
  for (std::size_t p = 0; p < rigid.size(); ++p) {
    std::vector<Vec3> first, now;
    const auto points_at = [&](std::size_t time, std::vector<Vec3>& out) {
      const auto positions = cache.sample(time);
      out.clear();
      for (std::size_t i = 0; i < vertices[p].size(); i += 1 + vertices[p].size() / k_points)
        out.push_back(positions[vertices[p][i]].cast<double>());
    };
    points_at(0, first);
    if (first.empty()) continue;
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : first) centre += x / static_cast<double>(first.size());
    double radius2 = 0;
    for (const Vec3& x : first) radius2 += (x - centre).squaredNorm();
    for (std::size_t k = 1; k <= std::min(k_times, times - 1) && rigid[p] != 0; ++k) {
      points_at(k * (times - 1) / std::min(k_times, times - 1), now);
      const Eigen::Isometry3d motion = rigid_fit(first, now);
      double bent2 = 0;
      for (std::size_t i = 0; i < now.size(); ++i) bent2 += (motion * first[i] - now[i]).squaredNorm();
      if (bent2 > k_bent * k_bent * radius2) rigid[p] = 0;
    }
  }
  return rigid;
}

}  // namespace

SampledTrajectory::SampledTrajectory(GeometryCache cache, const Mat3& axes, double unit_scale, const Playback& playback,
                                     bool sheet)
    : cache_(std::move(cache)), linear_(unit_scale * axes), playback_(playback) {
  find_jumps();
  find_cycle();
  std::vector<Vec3> positions(static_cast<std::size_t>(cache_.vertex_count));
  at(playback_.start, positions);
  std::vector<Vec3> later(positions.size());
  at(playback_.start + k_speed_interval * playback_.speed, later);
  for (std::size_t v = 0; v < later.size(); ++v) start_velocity_ += (later[v] - positions[v]) / k_speed_interval;
  if (!later.empty()) start_velocity_ /= static_cast<double>(later.size());
  if (playback_.bind) {
    placed_bind_.resize(positions.size());
    at(*playback_.bind, placed_bind_);
    bind_to_start_ = rigid_fit(placed_bind_, positions);
    for (Vec3& p : placed_bind_) p = bind_to_start_ * p;
  }
  for (const Triangle& t : triangulate(cache_.mesh))
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) surface_.triangles.push_back(t);
  int pieces = 0;
  surface_.part_of_vertex = connected_pieces(cache_.vertex_count, surface_.triangles, pieces);
  for (int p = 0; p < pieces; ++p) surface_.parts.push_back({"piece " + std::to_string(p + 1), -1, 0});
  for (const Triangle& t : surface_.triangles) {
    const auto piece = static_cast<std::size_t>(surface_.part_of_vertex[static_cast<std::size_t>(t[0])]);
    const auto p = [&](int k) -> const Vec3& {
      return positions[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
    };
    surface_.parts[piece].size += (p(0) - positions[0]).dot((p(1) - positions[0]).cross(p(2) - positions[0])) / 6;
  }
  int largest = 0;
  for (int p = 0; p < pieces; ++p) {
    SurfacePart& part = surface_.parts[static_cast<std::size_t>(p)];
    part.size = std::abs(part.size);
    if (part.size > surface_.parts[static_cast<std::size_t>(largest)].size) largest = p;
  }
  if (sheet) {
    for (SurfacePart& part : surface_.parts) part.size = 0, part.sheet = true;
    return;
  }
  const std::vector<char> rigid = rigid_pieces(cache_, surface_.part_of_vertex, pieces);
  for (int p = 0; p < pieces; ++p) {
    if (p == largest) continue;
    surface_.parts[static_cast<std::size_t>(p)].parent = largest;
    surface_.parts[static_cast<std::size_t>(p)].folds = rigid[ft::at(p)] != 0 && rigid[ft::at(largest)] != 0;
  }
}

/// Per interval and vertex: whether it is elsewhere afterwards, and moves neither before nor after as if it were going
/// there.
bool SampledTrajectory::jumps(std::size_t interval, std::size_t vertex) const {
  const auto move = [&](std::size_t i) -> Vec3 {
    return linear_ * (cache_.sample(i + 1)[vertex] - cache_.sample(i)[vertex]).cast<double>();
  };
  const Vec3 own = move(interval);
  const double least =
      k_limb_jump * least_jump(size_, cache_.times[interval + 1] - cache_.times[interval]);  // of the nearer of both
  if (interval > 0 && (own - move(interval - 1)).norm() <= least) return false;
  if (interval + 2 < cache_.times.size() && (own - move(interval + 1)).norm() <= least) return false;
  return own.norm() > least;
}

void SampledTrajectory::find_jumps() {
  Box box;
  for (const Vec3f& p : cache_.sample(0)) box.include((linear_ * p.cast<double>()).eval());
  size_ = box.size().maxCoeff();
  if (cache_.times.size() < 3) return;
  any_jumps_.assign(cache_.times.size() - 1, 0);
  parallel_tasks(any_jumps_.size(), [&](std::size_t i) {
    for (std::size_t v = 0; v < ft::at(cache_.vertex_count) && any_jumps_[i] == 0; ++v) any_jumps_[i] = jumps(i, v);
  });
}

void SampledTrajectory::find_cycle() {
  const double period = cache_.times.back() - cache_.times.front();
  if (!playback_.loop || !(period > 0)) return;
  std::vector<Vec3> first(ft::at(cache_.vertex_count)), last(first.size());
  at_own(cache_.times.front(), first);
  at_own(cache_.times.back(), last);
  cycle_ = make_cycle(period, level_fit(first, last), size_);
  for (std::size_t v = 0; v < first.size(); ++v)
    cycle_.seam = std::max(cycle_.seam, (cycle_.step * first[v] - last[v]).norm());
}

/// At a sample [file units/s].
Vec3 SampledTrajectory::tangent(std::size_t i, std::size_t vertex) const {
  std::size_t before = i > 0 ? i - 1 : i, after = i + 1 < cache_.times.size() ? i + 1 : i;
  if (!any_jumps_.empty()) {
    if (before < i && any_jumps_[before] != 0 && jumps(before, vertex)) before = i;
    if (after > i && any_jumps_[i] != 0 && jumps(i, vertex)) after = i;
    if (before == after) return Vec3::Zero();
  }
  return (cache_.sample(after)[vertex] - cache_.sample(before)[vertex]).cast<double>() /
         (cache_.times[after] - cache_.times[before]);
}

Eigen::Isometry3d SampledTrajectory::bind_to_start() const {
  return Eigen::Translation3d(run_up_offset(start_velocity_, -playback_.preroll, playback_.preroll)) * bind_to_start_;
}

void SampledTrajectory::sample(double time, std::span<Vec3> positions) const {
  at(playback_.start + std::max(time, 0.0) * playback_.speed, positions);
  if (time < 0 && playback_.preroll > 0 && !placed_bind_.empty()) {
    const double weight = blend_weight(time, playback_.preroll);
    for (std::size_t v = 0; v < positions.size(); ++v)
      positions[v] = (1 - weight) * placed_bind_[v] + weight * positions[v];
  }
  const Vec3 offset = run_up_offset(start_velocity_, time, playback_.preroll);
  if (offset != Vec3::Zero())
    for (Vec3& p : positions) p += offset;
}

void SampledTrajectory::at(double time, std::span<Vec3> positions) const {
  constexpr double k_rounding = 1e-9;  // s
  const long before =
      cycle_.period > 0 ? static_cast<long>(std::floor((time - cache_.times.front() + k_rounding) / cycle_.period)) : 0;
  if (before <= 0) return at_own(time, positions);
  at_own(time - static_cast<double>(before) * cycle_.period, positions);
  const Eigen::Isometry3d carried = cycle_.steps(before);
  for (Vec3& p : positions) p = carried * p;
}

void SampledTrajectory::at_own(double time, std::span<Vec3> positions) const {
  const auto& times = cache_.times;
  const auto next = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  if (next == 0 || next == times.size()) {
    const auto held = cache_.sample(next == 0 ? 0 : next - 1);
    for (std::size_t v = 0; v < positions.size(); ++v) positions[v] = linear_ * held[v].cast<double>();
    return;
  }
  const std::size_t last = next - 1;
  const double span = times[next] - times[last], u = (time - times[last]) / span, u2 = u * u, u3 = u2 * u;
  const double h00 = 2 * u3 - 3 * u2 + 1, h10 = (u3 - 2 * u2 + u) * span, h01 = 3 * u2 - 2 * u3, h11 = (u3 - u2) * span;
  const auto a = cache_.sample(last), b = cache_.sample(next);
  parallel_for(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      positions[v] = linear_ * (h00 * a[v].cast<double>() + h10 * tangent(last, v) + h01 * b[v].cast<double>() +
                                h11 * tangent(next, v));
  });
}

}  // namespace ft::inline io

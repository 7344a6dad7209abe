#include "solvers/wind/body_paths.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

constexpr double k_samples_a_frame = 2;
constexpr double k_drag_coefficient = 1;  ///< of limbs and trunks across the flow, 0.9 to 1.2 (Hoerner 1965)

struct PartShape {
  Vec3 centre = Vec3::Zero();
  double area = 0;
};

std::vector<PartShape> shapes_of(const Surface& surface, std::span<const Vec3> x) {
  std::vector<PartShape> out(surface.parts.size());
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = x[at(t[0])], &b = x[at(t[1])], &c = x[at(t[2])];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    PartShape& part = out[at(surface.part_of_vertex[at(t[0])])];
    part.centre += area / 3 * (a + b + c);
    part.area += area;
  }
  for (PartShape& part : out)
    if (part.area > 0) part.centre /= part.area;
  return out;
}

/// Share of the way from one sample to the next, and which.
std::pair<std::size_t, double> between(double time, double first, double interval, std::size_t count) {
  const double place = std::clamp((time - first) / interval, 0.0, static_cast<double>(count - 1));
  const std::size_t i = std::min(static_cast<std::size_t>(place), count - 2);
  return {i, place - static_cast<double>(i)};
}

}  // namespace

BodyPaths::BodyPaths(std::vector<BodyPath> paths, double first_time, double interval)
    : paths_(std::move(paths)), first_time_(first_time), interval_(interval) {
  CHECK(!paths_.empty() && interval > 0);
  for (const BodyPath& path : paths_) {
    CHECK(path.centres.size() >= 2 && path.centres.size() == paths_.front().centres.size());
    CHECK(path.velocities.size() == path.centres.size());
    for (const Vec3& v : path.velocities) fastest_ = std::max(fastest_, v.norm());
  }
}

Vec3 BodyPaths::centre(const BodyPath& path, double time) const {
  const auto [i, share] = between(time, first_time_, interval_, path.centres.size());
  return (1 - share) * path.centres[i] + share * path.centres[i + 1];
}

Vec3 BodyPaths::velocity(const BodyPath& path, double time) const {
  if (time < first_time_ || time > time_of(samples() - 1)) return Vec3::Zero();
  const auto [i, share] = between(time, first_time_, interval_, path.velocities.size());
  return (1 - share) * path.velocities[i] + share * path.velocities[i + 1];
}

Result<BodyPaths> paths_of(const Trajectory& body, const PathRequest& request) {
  const Surface& surface = body.surface();
  const double interval = 1 / (k_samples_a_frame * request.fps);
  const int count = std::max(2, static_cast<int>(std::lround((request.last_time - request.first_time) / interval)) + 1);
  std::vector<Vec3> x(at(surface.vertex_count()));
  std::vector<BodyPath> all(surface.parts.size());
  for (int s = 0; s < count; ++s) {
    body.sample(request.first_time + s * interval, x);
    const std::vector<PartShape> shapes = shapes_of(surface, x);
    for (std::size_t p = 0; p < all.size(); ++p) {
      all[p].centres.push_back(shapes[p].centre);
      if (s == 0) all[p].drag_area = k_drag_coefficient * shapes[p].area / 4;
    }
  }
  std::vector<BodyPath> paths;
  double total = 0;
  for (std::size_t p = 0; p < all.size(); ++p) {
    const bool wanted = request.parts.empty() || std::find(request.parts.begin(), request.parts.end(),
                                                           static_cast<int>(p)) != request.parts.end();
    if (!wanted || !(all[p].drag_area > 0)) continue;
    all[p].name = surface.parts[p].name;
    total += all[p].drag_area;
    const auto jumps_between = [&](int from, int to) {
      return std::any_of(request.jumps.begin(), request.jumps.end(), [&](double jump) {
        const double half = 0.5 * interval;
        return jump > request.first_time + from * interval + half - interval &&
               jump <= request.first_time + to * interval + half;
      });
    };
    for (int s = 0; s < count; ++s) {
      const int from = std::max(0, s - 1), to = std::min(count - 1, s + 1);
      all[p].velocities.emplace_back(Vec3::Zero());
      if (!jumps_between(from, to))
        all[p].velocities.back() = (all[p].centres[at(to)] - all[p].centres[at(from)]) / ((to - from) * interval);
    }
    paths.push_back(std::move(all[p]));
  }
  if (paths.empty()) return usage_error("none of these parts has a surface that could leave a wake");
  if (request.drag_area > 0)
    for (BodyPath& path : paths) path.drag_area *= request.drag_area / total;
  return BodyPaths(std::move(paths), request.first_time, interval);
}

}  // namespace ft::inline solvers

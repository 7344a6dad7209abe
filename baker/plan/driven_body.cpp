#include "baker/plan/driven_body.h"

#include <array>
#include <cmath>
#include <map>

#include "baker/core/parallel.h"
#include "baker/core/volume.h"

namespace ft::inline baker {
namespace {

/// Twice its area, along its normal [m2].
Vec3 cross_of(const Triangle& t, std::span<const Vec3> x) {
  return (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
}
Vec3 middle_of(const Triangle& t, std::span<const Vec3> x) {
  return (x[at(t[0])] + x[at(t[1])] + x[at(t[2])]) / 3;
}

/// Places given at every frame. Between the middles of two intervals the acceleration is the second difference, so that
/// the speed changes by what it does in the clip and swings nowhere beyond it: what a mat is to give in the place of
/// the floor is read from it. A quadratic B-spline: corners are cut by an eighth of the second difference.
struct Curve {
  std::vector<Vec3> place, velocity, acceleration;

  Curve(std::span<const Vec3> x, double fps)
      : place(x.begin(), x.end()), velocity(x.size(), Vec3::Zero()), acceleration(velocity) {
    const std::size_t n = x.size();
    if (n < 2) return;
    for (std::size_t i = 1; i + 1 < n; ++i) acceleration[i] = fps * fps * (x[i + 1] - 2 * x[i] + x[i - 1]);
    if (n > 2) acceleration[0] = acceleration[1], acceleration[n - 1] = acceleration[n - 2];
    for (std::size_t i = 0; i < n; ++i) {
      velocity[i] = i + 1 < n ? Vec3(fps * (x[i + 1] - x[i]) - 0.5 / fps * acceleration[i])
                              : Vec3(fps * (x[i] - x[i - 1]) + 0.5 / fps * acceleration[i]);
      place[i] += 0.125 / (fps * fps) * acceleration[i];
    }
  }
};

/// The nearest frame, and the time since it [s].
struct Instant {
  std::size_t frame = 0;
  double since = 0;
};
Instant instant_at(double time, double fps, std::size_t count) {
  const double x = std::clamp(time * fps, 0.0, static_cast<double>(count - 1)), frame = std::round(x);
  return {static_cast<std::size_t>(frame), (x - frame) / fps};
}

Vec3 place_at(const Curve& c, const Instant& i) {
  return c.place[i.frame] + i.since * c.velocity[i.frame] + 0.5 * i.since * i.since * c.acceleration[i.frame];
}
Vec3 velocity_at(const Curve& c, const Instant& i) {
  return c.velocity[i.frame] + i.since * c.acceleration[i.frame];
}

/// A point over the frames: where it is from the centre of mass [m], and its area along its normal [m2].
struct PointCurve {
  Curve place;
  std::vector<Vec3> area;
  double volume = 0;
};

}  // namespace

std::vector<BodyPoint> body_points(const Surface& surface, std::span<const Vec3> bind, std::span<const Triangle> chosen,
                                   double across, double volume) {
  CHECK(across > 0);
  std::vector<Vec3> middle(surface.parts.size(), Vec3::Zero());
  std::vector<int> count(surface.parts.size(), 0);
  for (std::size_t v = 0; v < bind.size(); ++v) {
    const std::size_t part = at(surface.part_of_vertex[v]);
    middle[part] += bind[v], ++count[part];
  }
  for (std::size_t p = 0; p < middle.size(); ++p)
    if (count[p] > 0) middle[p] /= count[p];

  // Part, side, cell.
  std::map<std::array<long, 5>, BodyPoint> cells;
  double sum = 0;
  for (const Triangle& t : chosen) {
    const Vec3 cross = cross_of(t, bind), centre = middle_of(t, bind);
    int axis = 0;
    cross.cwiseAbs().maxCoeff(&axis);
    const int part = surface.part_of_vertex[at(t[0])];
    BodyPoint& point = cells[{part, 2 * axis + (cross[axis] > 0), std::lround(centre.x() / across),
                              std::lround(centre.y() / across), std::lround(centre.z() / across)}];
    point.triangles.push_back(t);
    const double enclosed = std::abs((centre - middle[at(part)]).dot(cross)) / 6;
    point.volume += enclosed, sum += enclosed;
  }
  std::vector<BodyPoint> out;
  for (auto& [key, point] : cells) {
    point.volume *= sum > 0 ? volume / sum : 0;
    out.push_back(std::move(point));
  }
  return out;
}

YieldingBody driven_body(const Trajectory& trajectory, const std::vector<BodyPoint>& points, double mass,
                         int frame_count, double fps) {
  CHECK(frame_count > 0 && fps > 0);
  const auto frames = at(frame_count);
  std::vector<Vec3> centres(frames);
  std::vector<std::vector<Vec3>> places(points.size(), std::vector<Vec3>(frames)), areas = places;
  parallel_for(frames, 4, [&](std::size_t begin, std::size_t end) {
    std::vector<Vec3> x(at(trajectory.surface().vertex_count()));
    for (std::size_t f = begin; f < end; ++f) {
      trajectory.sample(static_cast<double>(f) / fps, x);
      centres[f] = volume_centre(x, trajectory.surface().triangles);
      for (std::size_t p = 0; p < points.size(); ++p) {
        Vec3 place = Vec3::Zero(), area = Vec3::Zero();
        double weight = 0;
        for (const Triangle& t : points[p].triangles) {
          const Vec3 cross = cross_of(t, x);
          place += cross.norm() * middle_of(t, x), weight += cross.norm(), area += 0.5 * cross;
        }
        places[p][f] = (weight > 0 ? Vec3(place / weight) : x[at(points[p].triangles[0][0])]) - centres[f];
        areas[p][f] = area;
      }
    }
  });
  const auto centre = std::make_shared<const Curve>(centres, fps);
  const auto curves = std::make_shared<std::vector<PointCurve>>();
  for (std::size_t p = 0; p < points.size(); ++p)
    curves->push_back({Curve(places[p], fps), std::move(areas[p]), points[p].volume});

  YieldingBody out;
  out.mass = {mass, mass * Mat3::Identity()};  // it does not turn: its inertia is not asked for
  out.motion = [centre, fps](double time) {
    const Instant now = instant_at(time, fps, centre->place.size());
    RigidMotion motion;
    motion.pose.position = place_at(*centre, now);
    motion.velocity = velocity_at(*centre, now);
    return motion;
  };
  out.shape = [curves, fps, frames, buffer = std::make_shared<std::vector<ShapeSample>>(points.size())](double time) {
    const Instant now = instant_at(time, fps, frames);
    const double away = now.since * fps;  // of the interval to the frame before or after
    const std::size_t beside = away < 0 ? now.frame - 1 : std::min(now.frame + 1, frames - 1);
    for (std::size_t i = 0; i < curves->size(); ++i) {
      const PointCurve& curve = (*curves)[i];
      ShapeSample& sample = (*buffer)[i];
      sample.place = place_at(curve.place, now);
      sample.velocity = velocity_at(curve.place, now);
      const Vec3 area = curve.area[now.frame] + std::abs(away) * (curve.area[beside] - curve.area[now.frame]);
      sample.area = area.norm();
      sample.normal = sample.area > 0 ? Vec3(area / sample.area) : Vec3(Vec3::Zero());
      sample.volume = curve.volume;
    }
    return std::span<const ShapeSample>(*buffer);
  };
  return out;
}

}  // namespace ft::inline baker

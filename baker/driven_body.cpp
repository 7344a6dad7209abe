#include "baker/driven_body.h"

#include <array>
#include <cmath>
#include <map>

#include "baker/core/parallel.h"
#include "baker/core/volume.h"

namespace ft {
namespace {

/// Twice its area, along its normal [m2].
Vec3 cross_of(const Triangle& t, std::span<const Vec3> x) {
  return (x[at(t[1])] - x[at(t[0])]).cross(x[at(t[2])] - x[at(t[0])]);
}
Vec3 middle_of(const Triangle& t, std::span<const Vec3> x) {
  return (x[at(t[0])] + x[at(t[1])] + x[at(t[2])]) / 3;
}

/// Numbers given at every frame, with a cubic in between whose slopes are central differences.
struct Curve {
  std::vector<Vec3> value, slope;  ///< one per frame, and per second

  Curve(std::vector<Vec3> values, double fps) : value(std::move(values)), slope(value.size(), Vec3::Zero()) {
    const std::size_t n = value.size();
    for (std::size_t i = 0; n > 1 && i < n; ++i) {
      const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, n - 1);
      slope[i] = fps / static_cast<double>(after - before) * (value[after] - value[before]);
    }
    if (n > 2) {  // at the ends a parabola through three
      slope[0] = fps * (-1.5 * value[0] + 2 * value[1] - 0.5 * value[2]);
      slope[n - 1] = fps * (1.5 * value[n - 1] - 2 * value[n - 2] + 0.5 * value[n - 3]);
    }
  }
};

struct Place {
  std::size_t frame = 0;
  double s = 0;  ///< to the next
};
Place place_at(double time, double fps, std::size_t count) {
  const double x = std::clamp(time * fps, 0.0, static_cast<double>(count - 1));
  const auto frame = std::min(static_cast<std::size_t>(x), count > 1 ? count - 2 : 0);
  return {frame, x - static_cast<double>(frame)};
}

Vec3 value_at(const Curve& c, const Place& p, double fps) {
  if (p.s == 0) return c.value[p.frame];
  const double s = p.s, dt = 1 / fps;
  const Vec3 &a = c.value[p.frame], &b = c.value[p.frame + 1];
  return a + s * s * (3 - 2 * s) * (b - a) + s * (1 - s) * dt * ((1 - s) * c.slope[p.frame] - s * c.slope[p.frame + 1]);
}
Vec3 slope_at(const Curve& c, const Place& p, double fps) {
  if (p.s == 0) return c.slope[p.frame];
  const double s = p.s;
  return 6 * s * (1 - s) * fps * (c.value[p.frame + 1] - c.value[p.frame]) + (1 - s) * (1 - 3 * s) * c.slope[p.frame] -
         s * (2 - 3 * s) * c.slope[p.frame + 1];
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

DrivenBody driven_body(const Trajectory& trajectory, const std::vector<BodyPoint>& points, double mass, int frame_count,
                       double fps) {
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
  const auto centre = std::make_shared<const Curve>(std::move(centres), fps);
  const auto curves = std::make_shared<std::vector<PointCurve>>();
  for (std::size_t p = 0; p < points.size(); ++p)
    curves->push_back({Curve(std::move(places[p]), fps), std::move(areas[p]), points[p].volume});

  DrivenBody out;
  out.mass = {mass, mass * Mat3::Identity()};  // it does not turn: its inertia is not asked for
  out.motion = [centre, fps](double time) {
    const Place p = place_at(time, fps, centre->value.size());
    RigidMotion motion;
    motion.pose.position = value_at(*centre, p, fps);
    motion.velocity = slope_at(*centre, p, fps);
    return motion;
  };
  out.shape = [curves, fps, frames, buffer = std::make_shared<std::vector<ShapeSample>>(points.size())](double time) {
    const Place p = place_at(time, fps, frames);
    for (std::size_t i = 0; i < curves->size(); ++i) {
      const PointCurve& curve = (*curves)[i];
      ShapeSample& sample = (*buffer)[i];
      sample.place = value_at(curve.place, p, fps);
      sample.velocity = slope_at(curve.place, p, fps);
      const Vec3 area =
          p.s == 0 ? curve.area[p.frame] : Vec3((1 - p.s) * curve.area[p.frame] + p.s * curve.area[p.frame + 1]);
      sample.area = area.norm();
      sample.normal = sample.area > 0 ? Vec3(area / sample.area) : Vec3(Vec3::Zero());
      sample.volume = curve.volume;
    }
    return std::span<const ShapeSample>(*buffer);
  };
  return out;
}

}  // namespace ft

#include "solvers/water/pond/float_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/volume.h"

namespace ft::inline solvers {
namespace {

constexpr double k_sudden = 0.2732 / 0.5;

double signed_volume(std::span<const Vec3> corners) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) sum += corners[i].dot(corners[i + 1].cross(corners[i + 2]));
  return sum / 6;
}

Vec3 signed_centre(std::span<const Vec3> corners) {
  Vec3 moment = Vec3::Zero();
  double sum = 0;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const double v = corners[i].dot(corners[i + 1].cross(corners[i + 2]));
    moment += 0.25 * v * (corners[i] + corners[i + 1] + corners[i + 2]);
    sum += v;
  }
  return sum != 0 ? Vec3(moment / sum) : moment;
}

/// The corners with p[axis] between lo and hi, closed by fans in both planes.
std::vector<Vec3> slab(const std::vector<Vec3>& corners, int axis, double lo, double hi) {
  std::vector<Vec3> now = corners;
  for (const auto& [place, sign] : {std::pair{lo, 1.0}, {hi, -1.0}}) {
    std::vector<Vec3> kept;
    Vec3 hub = Vec3::Zero();
    hub[axis] = place;
    for (std::size_t i = 0; i + 2 < now.size(); i += 3) {
      std::array<Vec3, 4> inside;
      std::size_t count = 0;
      std::array<Vec3, 2> cut;
      std::size_t leaves = 0;  // which of the cuts goes out
      std::size_t cuts = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3 &a = now[i + c], &b = now[i + (c + 1) % 3];
        const double ha = sign * (a[axis] - place), hb = sign * (b[axis] - place);
        if (ha >= 0) inside[count++] = a;
        if ((ha >= 0) == (hb >= 0)) continue;
        // From the inner end, whichever comes first: both triangles of an edge get the same bits.
        Vec3 p = ha >= 0 ? Vec3(a + (ha / (ha - hb)) * (b - a)) : Vec3(b + (hb / (hb - ha)) * (a - b));
        p[axis] = place;
        inside[count++] = p;
        if (ha >= 0) leaves = cuts;
        if (cuts < 2) cut[cuts++] = p;
      }
      for (std::size_t c = 1; c + 1 < count; ++c) kept.insert(kept.end(), {inside[0], inside[c], inside[c + 1]});
      // The boundary runs from where it goes out to where it comes in; the lid runs back.
      if (cuts == 2) kept.insert(kept.end(), {hub, cut[1 - leaves], cut[leaves]});
    }
    now = std::move(kept);
  }
  return now;
}

/// Lamb's (1932, art. 114) added mass of an ellipsoid over its displaced mass, along each axis.
Vec3 ellipsoid_added(const Vec3& half) {
  Vec3 out;
  for (int axis = 0; axis < 3; ++axis) {
    // lambda = s u / (1 - u) with s of the ellipsoid's size.
    const double s = half.squaredNorm() / 3;
    constexpr int steps = 2000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double u = (i + 0.5) / steps, w = u * u, lambda = s * w / (1 - w);
      const double weight = s / ((1 - w) * (1 - w)) * 2 * u / steps;
      double root = 1;
      for (int a = 0; a < 3; ++a) root *= half[a] * half[a] + lambda;
      sum += weight / ((half[axis] * half[axis] + lambda) * std::sqrt(root));
    }
    const double alpha = half.prod() * sum;
    out[axis] = alpha / (2 - alpha);
  }
  return out;
}

Submerged of_all(const FloatShape& shape, const RigidPose& pose, double level) {
  Submerged sum;
  for (const FloatPart& p : shape.parts) {
    const Submerged s = submerged(p, pose, level);
    sum.volume += s.volume, sum.area += s.area;
  }
  return sum;
}

/// Draft of the upright body, its area there, and the height of its centre: by halving.
void find_rest(const PondFloat& body, double density, double lowest, double highest, FloatShape& shape, double& draft,
               Submerged& rest) {
  RigidPose pose;
  pose.rotation = body.start.pose.rotation;
  // What sinks counts as half under.
  const double wanted = std::min(body.body.mass.mass / density, 0.999999 * shape.volume);
  double lo = lowest, hi = highest;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (lo + hi);
    (of_all(shape, pose, middle).volume < wanted ? lo : hi) = middle;
  }
  shape.rest_height = -0.5 * (lo + hi);
  double level = 0.5 * (lo + hi);
  if (body.body.mass.mass > 0.95 * density * shape.volume) level = 0.5 * (lowest + highest);
  rest = of_all(shape, pose, level);
  draft = level - lowest;
}

}  // namespace

double sudden_share(double submerged_share) {
  return k_sudden + (1 - k_sudden) * std::clamp(2 * submerged_share - 1, 0.0, 1.0);
}

FloatShape float_shape(const PondFloat& body, double density) {
  FloatShape out;
  std::vector<Vec3> corners;
  out.contact = contact_spheres(body.body);
  out.reach = out.contact.reach;
  for (const Triangle& t : body.body.triangles)
    for (const int v : t) corners.push_back(body.body.positions[at(v)]);
  out.volume = signed_volume(corners);
  const Box box = bounds(body.body.positions);
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    const Vec3 area = 0.5 * (corners[i + 1] - corners[i]).cross(corners[i + 2] - corners[i]);
    out.face += 0.5 * area.cwiseAbs();
  }
  double draft = 0;
  Submerged rest;
  if (ball_radius(body.body) > 0) {
    FloatPart ball;
    ball.ball_radius = std::cbrt(out.volume * 3 / (4 * std::numbers::pi));
    ball.volume = out.volume;
    out.parts.push_back(ball);
    out.face = Vec3::Constant(std::numbers::pi * ball.ball_radius * ball.ball_radius);
    find_rest(body, density, -ball.ball_radius, ball.ball_radius, out, draft, rest);
    out.depth = std::clamp(1.5 * rest.volume / rest.area, 0.6 * ball.ball_radius, 1.5 * ball.ball_radius);
    return out;
  }
  // Which axis is up; the longer of the others is the length.
  const Vec3 up = body.start.pose.rotation.conjugate() * Vec3::UnitY();
  int vertical = 0;
  up.cwiseAbs().maxCoeff(&vertical);
  int length = (vertical + 1) % 3, width = (vertical + 2) % 3;
  const Vec3 size = box.size();
  if (size[width] > size[length]) std::swap(width, length);
  const int along = std::clamp(static_cast<int>(1.5 * size[length] / size[width] + 0.5), 2, 5), across = 2;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const double l = size[length] / along, w = size[width] / across;
      const double from = box.lo[length] + i * l, side = box.lo[width] + j * w;
      FloatPart part;
      part.corners = slab(slab(corners, length, i == 0 ? from - l : from, i + 1 == along ? from + 2 * l : from + l),
                          width, j == 0 ? side - w : side, j + 1 == across ? side + 2 * w : side + w);
      part.volume = signed_volume(part.corners);
      part.centre = signed_centre(part.corners);
      if (part.volume > 1e-9 * out.volume) out.parts.push_back(std::move(part));
    }
  Box world;
  for (const Vec3& p : body.body.positions) world.include(body.start.pose.rotation * p);
  find_rest(body, density, world.lo.y(), world.hi.y(), out, draft, rest);
  Vec3 half = 0.5 * size;
  half[vertical] = std::max(draft, 0.02 * size.minCoeff());
  out.added = ellipsoid_added(half);
  const double heave = out.added[vertical];
  out.depth = rest.area > 0 ? (1 + heave) * rest.volume / rest.area : out.reach;
  out.depth = std::clamp(out.depth, 0.15 * size.maxCoeff(), out.reach);
  return out;
}

}  // namespace ft::inline solvers

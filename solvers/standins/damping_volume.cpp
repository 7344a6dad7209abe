#include "solvers/standins/damping_volume.h"

#include <algorithm>
#include <cmath>

#include "collision/check/penetration.h"

namespace ft::inline solvers {
namespace {

double box_depth(const Vec3& p, const Vec3& size) {
  return (0.5 * size - p.cwiseAbs()).minCoeff();
}

/// Radius r at height y runs linearly between the two ends; the side's slope makes the distance shorter than that.
double cone_depth(const Vec3& p, const StandInSpec& s) {
  const double half = 0.5 * s.height, slope = (s.radius_top - s.radius_bottom) / s.height;
  const double radius = 0.5 * (s.radius_top + s.radius_bottom) + slope * p.y();
  const double side = (radius - std::hypot(p.x(), p.z())) / std::hypot(1, slope);
  return std::min(side, half - std::abs(p.y()));
}

}  // namespace

DampingVolume::DampingVolume(const StandInSpec& spec)
    : StandIn(spec), positions_(spec.mesh.positions), triangles_(triangulate(spec.mesh)) {
  if (spec.shape != VolumeShape::k_mesh) return;
  surface_.emplace(triangles_);
  surface_->move(positions_);
}

Result<std::unique_ptr<StandIn>> DampingVolume::make(const StandInSpec& s) {
  if (auto fault = check(s, false)) return *fault;
  return std::unique_ptr<StandIn>(new DampingVolume(s));
}

std::optional<Error> DampingVolume::check(const StandInSpec& s, bool may_be_undamped) {
  const double weakest = std::min({s.damping, s.damping_quadratic, s.damping_spin, s.damping_axes.minCoeff()});
  if (!(weakest >= 0)) return usage_error("a damping volume never pushes: damping must be 0 or more", s.name);
  if (!may_be_undamped && s.damping == 0 && s.damping_quadratic == 0 && s.damping_spin == 0)
    return usage_error("the damping volume does nothing", s.name,
                       "write damping [kg/s], damping_quadratic [kg/m] or damping_spin [kg m2/s]");
  if (s.shape == VolumeShape::k_box && !(s.size.minCoeff() > 0))
    return usage_error("a damping volume that is a box needs a size above 0 on every axis", s.name);
  if (s.shape == VolumeShape::k_cone &&
      !(s.height > 0 && std::min(s.radius_top, s.radius_bottom) >= 0 && std::max(s.radius_top, s.radius_bottom) > 0))
    return usage_error("a damping volume that is a cone needs a height and at least one radius above 0", s.name);
  if (s.shape == VolumeShape::k_mesh) {
    if (s.mesh.positions.empty()) return usage_error("a damping volume that is a mesh needs one", s.name);
    const auto triangles = triangulate(s.mesh);
    std::vector<Edge> sides;
    for (const Triangle& t : triangles)
      for (int k = 0; k < 3; ++k) {
        const int a = t[at(k)], b = t[at((k + 1) % 3)];
        sides.push_back({std::min(a, b), std::max(a, b)});
      }
    double volume = 0;
    for (const Triangle& t : triangles)
      volume += s.mesh.positions[at(t[0])].dot(s.mesh.positions[at(t[1])].cross(s.mesh.positions[at(t[2])])) / 6;
    std::sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size(); ++i)
      if ((i == 0 || sides[i] != sides[i - 1]) && (i + 1 == sides.size() || sides[i] != sides[i + 1]))
        return usage_error("the mesh of a damping volume must be closed", s.name, "cap its openings");
    if (!(volume > 0))
      return usage_error("the mesh of a damping volume is turned inside out", s.name, "flip its faces");
  }
  return {};
}

double DampingVolume::depth(const Vec3& place) const {
  const Vec3 p = local(place);
  if (spec().shape == VolumeShape::k_box) return box_depth(p, spec().size);
  if (spec().shape == VolumeShape::k_cone) return cone_depth(p, spec());
  const auto found = penetrations(std::span(&p, 1), *surface_, 0);
  return found.empty() ? 0 : found.front().depth;
}

double DampingVolume::share(const BodyState& body) const {
  const auto weight = [&](const Vec3& place) { return ramp(depth(place)); };
  double inside = 0, all = 0;
  for (const ShapeSample& s : body.shape) {
    if (s.volume <= 0) continue;
    inside += s.volume * weight(body.motion.pose * s.place);
    all += s.volume;
  }
  return all > 0 ? inside / all : weight(body.motion.pose.position);
}

bool DampingVolume::reaches(const BodyState& body, double) const {
  return share(body) > 0;
}

StandInForce DampingVolume::law(const BodyState& body) const {
  StandInForce out;
  const double w = share(body);
  if (w == 0) return out;
  const Vec3& v = body.motion.velocity;
  const double speed = v.norm();
  const Mat3 c = spec().damping * turned() * spec().damping_axes.asDiagonal() * turned().transpose();
  Mat3 tangent = c + spec().damping_quadratic * speed * Mat3::Identity();
  out.wrench.force = -w * (tangent * v);
  if (speed > 0) tangent += spec().damping_quadratic / speed * v * v.transpose();
  out.wrench.torque = -w * spec().damping_spin * body.motion.spin;
  out.damping.topLeftCorner<3, 3>() = w * tangent;
  out.damping.bottomRightCorner<3, 3>() = w * spec().damping_spin * Mat3::Identity();
  return out;
}

}  // namespace ft::inline solvers

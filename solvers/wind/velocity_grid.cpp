#include "solvers/wind/velocity_grid.h"

#include <algorithm>
#include <cmath>

#include "baker/core/check.h"

namespace ft::inline solvers {
namespace {

Vec3 at_voxel(const VelocityVoxels& frame, int i, int j, int k) {
  const auto& n = frame.count;
  if (i < 0 || j < 0 || k < 0 || i >= n[0] || j >= n[1] || k >= n[2]) return Vec3::Zero();
  return frame.velocities[at(i) + at(n[0]) * (at(j) + at(n[1]) * at(k))].cast<double>();
}

/// p: in voxels from the lowest one.
Vec3 trilinear(const VelocityVoxels& frame, const Vec3& p) {
  for (int c = 0; c < 3; ++c)
    if (!(p[c] > -1 && p[c] < frame.count[at(c)])) return Vec3::Zero();
  const Eigen::Vector3i lower = p.array().floor().cast<int>();
  const Vec3 w = p - lower.cast<double>();
  Vec3 out = Vec3::Zero();
  for (int corner = 0; corner < 8; ++corner) {
    const int di = corner & 1, dj = corner >> 1 & 1, dk = corner >> 2;
    const double share = (di ? w.x() : 1 - w.x()) * (dj ? w.y() : 1 - w.y()) * (dk ? w.z() : 1 - w.z());
    out += share * at_voxel(frame, lower.x() + di, lower.y() + dj, lower.z() + dk);
  }
  return out;
}

}  // namespace

VelocityGrid::VelocityGrid(std::vector<VelocityVoxels> frames, double first_time, double fps)
    : frames_(std::move(frames)), first_time_(first_time), fps_(fps) {
  CHECK(!frames_.empty());
  CHECK(fps_ > 0);
  for (const VelocityVoxels& frame : frames_) {
    CHECK(frame.velocities.size() == at(frame.count[0]) * at(frame.count[1]) * at(frame.count[2]));
    to_voxels_.push_back(Eigen::Translation3d(-frame.lowest[0], -frame.lowest[1], -frame.lowest[2]) *
                         frame.to_world.inverse());
    for (const Vec3f& v : frame.velocities) fastest_ = std::max(fastest_, v.cast<double>().norm());
  }
}

Vec3 VelocityGrid::velocity(const Vec3& place, double time) const {
  const double last = static_cast<double>(frames_.size() - 1);
  const double t = std::clamp((time - first_time_) * fps_, 0.0, last);
  const auto before = static_cast<std::size_t>(t);
  const double w = t - static_cast<double>(before);
  const Vec3 v = trilinear(frames_[before], to_voxels_[before] * place);
  if (w == 0) return v;
  return (1 - w) * v + w * trilinear(frames_[before + 1], to_voxels_[before + 1] * place);
}

}  // namespace ft::inline solvers

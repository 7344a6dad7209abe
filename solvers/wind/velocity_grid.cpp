#include "solvers/wind/velocity_grid.h"

namespace ft::inline solvers {
VelocityGrid::VelocityGrid(std::vector<VelocityVoxels> frames, double first_time, double fps)
    : frames_(std::move(frames)), first_time_(first_time), fps_(fps) {}
Vec3 VelocityGrid::velocity(const Vec3&, double) const { return Vec3::Zero() * first_time_ * fps_; }
}

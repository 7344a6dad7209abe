#include "io/volume/openvdb_cavity.h"

#include <openvdb/math/Proximity.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

namespace ft::inline io {
namespace {

namespace vdb = openvdb;

constexpr float k_beside = 1e-3f;  ///< a vertex is above its place if it is so near to it, of a cell [1]

/// A closed mesh in voxels: the patch with some of the surface around it, its sides and its floor.
struct ClosedPatch {
  std::vector<vdb::Vec3s> points;
  std::vector<vdb::Vec3I> triangles;
  std::vector<std::size_t> vertices;  ///< of the surface, of the first points
  std::size_t of_surface = 0;         ///< first triangles are the surface's

  std::size_t polygonCount() const { return triangles.size(); }
  std::size_t pointCount() const { return points.size(); }
  static std::size_t vertexCount(std::size_t) { return 3; }
  void getIndexSpacePoint(std::size_t triangle, std::size_t corner, vdb::Vec3d& out) const {
    out = points[triangles[triangle][static_cast<int>(corner)]];
  }
};

ClosedPatch closed_patch(const LiquidFrame& water, const DrawnInPatch& patch, double far) {
  ClosedPatch out;
  const double cell = water.surface[1].x() - water.surface[0].x();
  const int margin = static_cast<int>(std::ceil(far / cell)) + 1;
  const int i0 = std::max(0, patch.first_i - margin), i1 = std::min(water.across - 1, patch.last_i + margin);
  const int k0 = std::max(0, patch.first_k - margin), k1 = std::min(water.along - 1, patch.last_k + margin);
  const int across = i1 - i0 + 1, along = k1 - k0 + 1;
  const auto in_voxels = [&](const Vec3f& p) { return vdb::Vec3s(p.x(), p.y(), p.z()) / water.voxel; };
  for (int k = k0; k <= k1; ++k)
    for (int i = i0; i <= i1; ++i) {
      out.vertices.push_back(at(k) * at(water.across) + at(i));
      out.points.push_back(in_voxels(water.surface[out.vertices.back()]));
    }
  const auto top = [&](int i, int k) { return static_cast<std::uint32_t>(k * across + i); };
  const auto square = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    out.triangles.emplace_back(a, b, c);
    out.triangles.emplace_back(a, c, d);
  };
  for (int k = 0; k + 1 < along; ++k)
    for (int i = 0; i + 1 < across; ++i) square(top(i, k), top(i, k + 1), top(i + 1, k + 1), top(i + 1, k));
  out.of_surface = out.triangles.size();
  // The rim, once around, and below it the floor's.
  std::vector<std::uint32_t> rim;
  for (int i = 0; i + 1 < across; ++i) rim.push_back(top(i, 0));
  for (int k = 0; k + 1 < along; ++k) rim.push_back(top(across - 1, k));
  for (int i = across - 1; i > 0; --i) rim.push_back(top(i, along - 1));
  for (int k = along - 1; k > 0; --k) rim.push_back(top(0, k));
  const auto low = static_cast<std::uint32_t>(out.points.size());
  const auto floor = static_cast<float>(water.floor / water.voxel);
  for (const std::uint32_t v : rim) out.points.emplace_back(out.points[v].x(), floor, out.points[v].z());
  const auto count = static_cast<std::uint32_t>(rim.size());
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint32_t next = (n + 1) % count;
    square(rim[n], rim[next], low + next, low + n);
  }
  const auto middle = static_cast<std::uint32_t>(out.points.size());
  out.points.emplace_back(0.5f * (out.points[low] + out.points[low + at(across) - 1 + at(along) - 1]));
  for (std::uint32_t n = 0; n < count; ++n) out.triangles.emplace_back(low + n, low + (n + 1) % count, middle);
  return out;
}

}  // namespace

std::optional<DrawnInPatch> drawn_in_patch(const LiquidFrame& water) {
  const Vec3f& low = water.surface.front();
  const float cell = water.surface[1].x() - low.x();
  DrawnInPatch out{water.across, -1, water.along, -1};
  for (int k = 0; k < water.along; ++k)
    for (int i = 0; i < water.across; ++i) {
      const Vec3f& p = water.surface[at(k) * at(water.across) + at(i)];
      const float beside = std::max(std::abs(p.x() - low.x() - cell * static_cast<float>(i)),
                                    std::abs(p.z() - low.z() - cell * static_cast<float>(k)));
      if (beside <= k_beside * cell) continue;
      out.first_i = std::min(out.first_i, i - 1), out.last_i = std::max(out.last_i, i + 1);
      out.first_k = std::min(out.first_k, k - 1), out.last_k = std::max(out.last_k, k + 1);
    }
  if (out.last_i < 0) return {};
  out.first_i = std::max(out.first_i, 0), out.last_i = std::min(out.last_i, water.across - 1);
  out.first_k = std::max(out.first_k, 0), out.last_k = std::min(out.last_k, water.along - 1);
  out.low = Vec2(low.x() + cell * out.first_i, low.z() + cell * out.first_k);
  out.high = Vec2(low.x() + cell * out.last_i, low.z() + cell * out.last_k);
  return out;
}

void visit_patch(const LiquidFrame& water, const DrawnInPatch& patch, double far,
                 const std::function<void(const VoxelOfSurface&)>& visit) {
  // Of two triangles as near as each other one thread always finds the same.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  const ClosedPatch mesh = closed_patch(water, patch, far);
  const auto band = static_cast<float>(std::ceil(far / water.voxel)) + 1;
  vdb::Int32Grid nearest(-1);
  const vdb::FloatGrid::Ptr distances = vdb::tools::meshToVolume<vdb::FloatGrid>(
      mesh, *vdb::math::Transform::createLinearTransform(1), band, band, vdb::tools::DISABLE_RENORMALIZATION, &nearest);
  const auto to_nearest = nearest.getConstAccessor();
  for (auto voxel = distances->cbeginValueOn(); voxel; ++voxel) {
    const vdb::Coord place = voxel.getCoord();
    const double distance = *voxel * water.voxel;
    if (!voxel.isVoxelValue() || !(std::abs(distance) < far) ||
        !patch.holds(place.x() * water.voxel, place.z() * water.voxel))
      continue;
    VoxelOfSurface out{{place.x(), place.y(), place.z()}, static_cast<float>(distance)};
    const int triangle = to_nearest.getValue(place);
    if (triangle >= 0 && static_cast<std::size_t>(triangle) < mesh.of_surface) {
      const vdb::Vec3I& corners = mesh.triangles[at(triangle)];
      vdb::Vec3d share;
      vdb::math::closestPointOnTriangleToPoint(mesh.points[corners[0]], mesh.points[corners[1]],
                                               mesh.points[corners[2]], place.asVec3d(), share);
      out.velocity = Vec3::Zero();
      for (int c = 0; c < 3; ++c) {
        const std::size_t v = mesh.vertices[corners[c]];
        if (!water.velocities.empty()) *out.velocity += share[c] * water.velocities[v].cast<double>();
        if (!water.foam.empty()) out.foam += share[c] * water.foam[v];
      }
    }
    visit(out);
  }
}

}  // namespace ft::inline io

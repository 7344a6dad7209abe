// Names and units as Blender, Houdini and Maya find them: see samples/README.md.
#include "io/volume/openvdb_write.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "baker/core/file.h"
#include "baker/core/hash.h"
#include "io/volume/openvdb_cavity.h"

namespace ft::inline io {
namespace {

namespace vdb = openvdb;

constexpr int k_band = 3;              ///< voxels on both sides of the surface
constexpr double k_foam_band = 1.5;    ///< the same, where foam fades to nothing
constexpr double k_least_foam = 1e-3;  ///< of the surface; less is none
/// Motion blur looks up the velocity where something may come from or go to, not only where it is: so far both ways
/// [frames]. Half a frame is a shutter that is open for all of it, about its middle.
constexpr double k_shutter = 0.5;
/// Where a file has its random identifier, and how long it is.
constexpr std::size_t k_identifier_at = 21, k_identifier_size = 36;

/// Heights and velocities between the vertices of a surface.
class Heights {
 public:
  explicit Heights(const LiquidFrame& water)
      : water_(water), low_(water.surface.front()), cell_(water.surface[1].x() - low_.x()) {}

  Vec2 low() const { return {low_.x(), low_.z()}; }
  Vec2 high() const {
    return {low_.x() + cell_ * static_cast<float>(water_.across - 1),
            low_.z() + cell_ * static_cast<float>(water_.along - 1)};
  }
  /// Height, slope, velocity and foam there.
  struct Place {
    double height = 0, slope = 0, foam = 0;
    Vec3 velocity = Vec3::Zero();
  };
  /// x, z: brought onto the surface.
  Place at_place(double x, double z) const {
    const double u = std::clamp((x - low_.x()) / cell_, 0.0, water_.across - 1.001),
                 w = std::clamp((z - low_.z()) / cell_, 0.0, water_.along - 1.001);
    const int i = static_cast<int>(u), k = static_cast<int>(w);
    const double a = u - i, b = w - k;
    const auto vertex = [&](int di, int dk) { return at(k + dk) * at(water_.across) + at(i + di); };
    const std::size_t v[4] = {vertex(0, 0), vertex(1, 0), vertex(0, 1), vertex(1, 1)};
    const double share[4] = {(1 - a) * (1 - b), a * (1 - b), (1 - a) * b, a * b};
    double y[4];
    Place out;
    for (int c = 0; c < 4; ++c) {
      y[c] = water_.surface[v[c]].y();
      out.height += share[c] * y[c];
      if (!water_.velocities.empty()) out.velocity += share[c] * water_.velocities[v[c]].cast<double>();
      if (!water_.foam.empty()) out.foam += share[c] * water_.foam[v[c]];
    }
    out.slope =
        std::hypot((1 - b) * (y[1] - y[0]) + b * (y[3] - y[2]), (1 - a) * (y[2] - y[0]) + a * (y[3] - y[1])) / cell_;
    return out;
  }

 private:
  const LiquidFrame& water_;
  Vec3f low_;
  float cell_;
};

/// Of a voxel's water so far from the surface.
double foam_beside(double foam, double distance, double voxel) {
  return foam * (1 - std::abs(distance) / (k_foam_band * voxel));
}

void fill_surface(const LiquidFrame& water, vdb::FloatGrid& surface, vdb::Vec3SGrid& velocity, vdb::FloatGrid& foam) {
  const Heights heights(water);
  const double h = water.voxel, far = k_band * h;
  const auto index = [&](double place) { return static_cast<int>(std::floor(place / h)); };
  auto to_surface = surface.getAccessor();
  auto to_velocity = velocity.getAccessor();
  auto to_foam = foam.getAccessor();
  const std::optional<DrawnInPatch> patch = drawn_in_patch(water);
  for (int iz = index(heights.low().y()) - k_band; iz <= index(heights.high().y()) + k_band + 1; ++iz)
    for (int ix = index(heights.low().x()) - k_band; ix <= index(heights.high().x()) + k_band + 1; ++ix) {
      const double x = ix * h, z = iz * h;
      if (patch && patch->holds(x, z)) continue;
      const Heights::Place place = heights.at_place(x, z);
      const double height = place.height, steep = std::sqrt(1 + place.slope * place.slope);
      const Vec3& v = place.velocity;
      const double beside = std::max(std::max(heights.low().x() - x, x - heights.high().x()),
                                     std::max(heights.low().y() - z, z - heights.high().y()));
      const double blurred = far + k_shutter / water.fps * v.norm();  // what flows along a slope comes across it, too
      for (int iy = index(water.floor) - k_band; iy <= index(height + blurred * steep) + 1; ++iy) {
        const double y = iy * h, above = (y - height) / steep;
        const double distance = std::max({above, beside, water.floor - y});
        if (std::abs(distance) < far) to_surface.setValue({ix, iy, iz}, static_cast<float>(distance));
        const double covered = foam_beside(place.foam, above, h);
        if (covered > k_least_foam && beside <= 0) to_foam.setValue({ix, iy, iz}, static_cast<float>(covered));
        if (std::abs(above) < blurred && beside < far && water.floor - y < far)
          to_velocity.setValue({ix, iy, iz}, vdb::Vec3s(vdb::Vec3d(v.x(), v.y(), v.z())));
      }
    }
  if (patch) {
    double fastest = 0;
    for (const Vec3f& v : water.velocities) fastest = std::max(fastest, static_cast<double>(v.norm()));
    visit_patch(water, *patch, far + k_shutter / water.fps * fastest, [&](const VoxelOfSurface& voxel) {
      const vdb::Coord place(voxel.place[0], voxel.place[1], voxel.place[2]);
      if (std::abs(voxel.distance) < far) to_surface.setValue(place, voxel.distance);
      if (!voxel.velocity) return;
      const Vec3& v = *voxel.velocity;
      if (std::abs(voxel.distance) < far + k_shutter / water.fps * v.norm())
        to_velocity.setValue(place, vdb::Vec3s(vdb::Vec3d(v.x(), v.y(), v.z())));
      const double covered = foam_beside(voxel.foam, voxel.distance, h);
      if (covered > k_least_foam) to_foam.setValue(place, static_cast<float>(covered));
    });
  }
  vdb::tools::signedFloodFill(surface.tree());
}

/// Of droplets together.
struct Drops {
  double volume = 0;
  Vec3 momentum = Vec3::Zero();  ///< over density

  void add(const Drops& other) { volume += other.volume, momentum += other.momentum; }
  vdb::Vec3s velocity() const {
    const Vec3 v = momentum / volume;
    return vdb::Vec3s(vdb::Vec3d(v.x(), v.y(), v.z()));
  }
};

std::map<vdb::Coord, Drops> drops_by_voxel(const LiquidFrame& water) {
  std::map<vdb::Coord, Drops> out;
  for (std::size_t i = 0; i < water.droplets.positions.size(); ++i) {
    const Vec3f& p = water.droplets.positions[i];
    const double width = water.droplets.widths.empty() ? 0.004 : water.droplets.widths[i];
    Drops drop{std::numbers::pi / 6 * width * width * width};
    if (!water.droplets.velocities.empty()) drop.momentum = drop.volume * water.droplets.velocities[i].cast<double>();
    out[vdb::Coord::round(vdb::Vec3d(p.x(), p.y(), p.z()) / water.voxel)].add(drop);
  }
  return out;
}

/// Voxels about the ways on which drops come and go while the shutter is open, one voxel wider all round, since
/// velocities are looked up between voxels.
std::map<vdb::Coord, Drops> ways_of(const std::map<vdb::Coord, Drops>& all, const LiquidFrame& water) {
  std::map<vdb::Coord, Drops> out;
  for (const auto& [place, drops] : all) {
    const vdb::Vec3d way = vdb::Vec3d(drops.velocity()) * (k_shutter / water.fps / water.voxel);
    const int steps = static_cast<int>(std::ceil(way.length()));
    std::set<vdb::Coord> near;
    for (int n = -steps; n <= steps; ++n) {
      const vdb::Coord there = vdb::Coord::round(place.asVec3d() + way * (static_cast<double>(n) / std::max(1, steps)));
      for (int k = 0; k < 27; ++k) near.insert(there.offsetBy(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    }
    for (const vdb::Coord& c : near) out[c].add(drops);
  }
  return out;
}

void fill_spray(const LiquidFrame& water, const vdb::FloatGrid& surface, vdb::FloatGrid& spray,
                vdb::Vec3SGrid& velocity) {
  const auto all = drops_by_voxel(water);
  const auto to_surface = surface.getConstAccessor();
  auto to_spray = spray.getAccessor();
  auto to_velocity = velocity.getAccessor();
  // More than a voxel above the surface nothing asks how that moves: there it is the droplets that matter.
  const auto is_free = [&](const vdb::Coord& c) {
    return !to_velocity.isValueOn(c) || to_surface.getValue(c) > water.voxel;
  };
  for (const auto& [place, drops] : all) {
    to_spray.setValue(place, static_cast<float>(std::min(1.0, drops.volume / std::pow(water.voxel, 3))));
    if (is_free(place)) to_velocity.setValue(place, drops.velocity());
  }
  for (const auto& [place, drops] : ways_of(all, water))
    if (!to_spray.isValueOn(place) && is_free(place)) to_velocity.setValue(place, drops.velocity());
}

/// Puts a hash of all others in the place of the identifier.
Status fix_identifier(const std::filesystem::path& path) {
  auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  if (bytes->size() < k_identifier_at + k_identifier_size) return output_error("is no OpenVDB file", path.string());
  std::fill_n(bytes->begin() + k_identifier_at, k_identifier_size, std::byte{'0'});
  const std::string hash = hash_bytes(*bytes).hex();
  std::string identifier = "00000000-0000-0000-0000-000000000000";
  for (std::size_t i = 0, from = 0; i < identifier.size() && from < hash.size(); ++i)
    if (identifier[i] != '-') identifier[i] = hash[from++];
  std::transform(identifier.begin(), identifier.end(), bytes->begin() + k_identifier_at,
                 [](char c) { return static_cast<std::byte>(c); });
  return write_file_durably(path, *bytes);
}

}  // namespace

Status write_liquid_vdb(const std::filesystem::path& path, const LiquidFrame& water) {
  vdb::initialize();
  const auto transform = vdb::math::Transform::createLinearTransform(water.voxel);
  const auto surface = vdb::FloatGrid::create(static_cast<float>(k_band * water.voxel));
  const auto velocity = vdb::Vec3SGrid::create(vdb::Vec3s(0));
  const auto spray = vdb::FloatGrid::create(0), foam = vdb::FloatGrid::create(0);
  surface->setName("surface"), velocity->setName("vel"), spray->setName("spray"), foam->setName("foam");
  surface->setGridClass(vdb::GRID_LEVEL_SET);
  for (const auto& fog : {spray, foam}) fog->setGridClass(vdb::GRID_FOG_VOLUME);
  velocity->setVectorType(vdb::VEC_CONTRAVARIANT_RELATIVE);
  velocity->insertMeta("unit", vdb::StringMetadata("m/s"));
  fill_surface(water, *surface, *velocity, *foam);
  fill_spray(water, *surface, *spray, *velocity);
  vdb::GridPtrVec grids{surface, velocity, spray};
  if (!water.foam.empty()) grids.push_back(foam);
  for (const auto& grid : grids) {
    grid->setTransform(transform->copy());
    grid->insertMeta("fps", vdb::DoubleMetadata(water.fps));
  }
  try {
    vdb::io::File file(path.string());
    file.setCompression(vdb::io::COMPRESS_BLOSC | vdb::io::COMPRESS_ACTIVE_MASK);
    file.write(grids);
    file.close();
  } catch (const std::exception& e) {
    return output_error(std::string("cannot be written: ") + e.what(), path.string());
  }
  return fix_identifier(path);
}

}  // namespace ft::inline io

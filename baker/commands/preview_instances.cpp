#include "baker/commands/preview_instances.h"

#include <algorithm>
#include <cmath>

#include "baker/commands/base64.h"

namespace ft::inline baker {
namespace {

constexpr double k_turn_step = 1.0 / 32767;
constexpr float k_size_steps = 255;

/// Bounds of all origins, and of each instance the largest scale.
struct Extent {
  Box box;
  std::vector<Vec3f> scale;
  bool sizes_change = false;
};

Result<Extent> extent_of(const CacheTrack& track, int frames) {
  Extent out;
  FrameData frame, before;
  for (int f = 0; f < frames; ++f) {
    if (const Status read = track.read(f, frame); !read) return read.error();
    for (const Vec3f& p : frame.positions) out.box.include(p.cast<double>());
    if (f == 0) out.scale = frame.scales;
    for (std::size_t i = 0; i < frame.scales.size(); ++i) {
      out.sizes_change = out.sizes_change || frame.scales[i] != out.scale[i];
      if (frame.scales[i].norm() > out.scale[i].norm()) out.scale[i] = frame.scales[i];
    }
  }
  if (out.scale.empty()) out.scale.assign(track.reader->info().instances.ids.size(), Vec3f::Ones());
  return out;
}

Json prototypes_of(const CacheTrack& track) {
  Json out = Json::array();
  for (const Mesh& mesh : track.prototypes) {
    std::vector<std::uint32_t> corners;
    for (const Triangle& t : triangulate(mesh))
      for (const int v : t) corners.push_back(static_cast<std::uint32_t>(v));
    std::vector<float> points;
    for (const Vec3& p : mesh.positions)
      for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(p[k]));
    out.push_back({{"name", mesh.name}, {"triangles", base64_of(corners)}, {"points", base64_of(points)}});
  }
  return out;
}

std::uint16_t place(double value, double low, double step) {
  return step > 0 ? static_cast<std::uint16_t>(std::lround((value - low) / step)) : std::uint16_t{0};
}

}  // namespace

Result<Json> preview_instances(const ManifestSystem& system, const CacheTrack& track, int frames) {
  auto extent = extent_of(track, frames);
  if (!extent) return extent.error();
  const Vec3 low = extent->box.lo, step = extent->box.size() / 65535.0;
  std::vector<std::uint16_t> positions;
  std::vector<std::int16_t> turns;
  std::vector<std::uint8_t> sizes;
  FrameData frame;
  for (int f = 0; f < frames; ++f) {
    if (const Status read = track.read(f, frame); !read) return read.error();
    for (const Vec3f& p : frame.positions)
      for (int k = 0; k < 3; ++k) positions.push_back(place(p[k], low[k], step[k]));
    for (const Eigen::Quaternionf& q : frame.orientations)
      for (int k = 0; k < 4; ++k)
        turns.push_back(static_cast<std::int16_t>(std::lround(std::clamp(q.coeffs()[k], -1.0f, 1.0f) / k_turn_step)));
    for (std::size_t i = 0; extent->sizes_change && i < frame.scales.size(); ++i) {
      const float most = extent->scale[i].norm();
      sizes.push_back(most > 0 ? static_cast<std::uint8_t>(std::lround(k_size_steps * frame.scales[i].norm() / most))
                               : std::uint8_t{0});
    }
  }
  const InstanceSet& set = track.reader->info().instances;
  std::vector<std::uint32_t> ids;
  std::vector<std::uint16_t> of;
  for (const std::uint64_t id : set.ids) ids.push_back(static_cast<std::uint32_t>(id));
  for (const int p : set.prototypes) of.push_back(static_cast<std::uint16_t>(p));
  std::vector<float> scale;
  for (const Vec3f& s : extent->scale) scale.insert(scale.end(), {s.x(), s.y(), s.z()});

  Json out{{"name", system.name}, {"role", system.role}, {"vertices", set.ids.size()}};
  out["low"] = {low[0], low[1], low[2]};
  out["step"] = {step[0], step[1], step[2]};
  out["positions"] = base64_of(positions);
  Json& own = out["instances"];
  own = {{"ids", base64_of(ids)},
         {"of", base64_of(of)},
         {"scale", base64_of(scale)},
         {"turns", base64_of(turns)},
         {"prototypes", prototypes_of(track)}};
  if (!sizes.empty()) own["sizes"] = base64_of(sizes);
  return out;
}

}  // namespace ft::inline baker

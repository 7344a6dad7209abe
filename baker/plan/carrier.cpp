#include "baker/plan/carrier.h"

#include <fmt/format.h>

#include <algorithm>

#include "baker/core/rigid.h"
#include "io/cache/cache.h"
#include "io/import/motion/sampled_trajectory.h"

namespace ft::inline baker {
namespace {

/// Samples of all frames, the pre-roll's first.
class CarrierTrajectory final : public Trajectory {
 public:
  CarrierTrajectory(const Carrier& carrier, GeometryCache samples, double preroll)
      : mesh_(carrier.mesh),
        preroll_(preroll),
        start_(start_of(*carrier.mesh, samples)),
        all_(std::move(samples), Mat3::Identity(), 1, Playback{.start = 0, .preroll = 0, .bind = {}}, carrier.sheet) {}

  const Surface& surface() const override { return all_.surface(); }
  void bind_pose(std::span<Vec3> positions) const override {
    std::copy(mesh_->positions.begin(), mesh_->positions.end(), positions.begin());
  }
  void sample(double time, std::span<Vec3> positions) const override { all_.sample(time + preroll_, positions); }
  Eigen::Isometry3d bind_to_start() const override { return start_; }
  double preroll() const override { return preroll_; }

 private:
  /// The rigid motion that takes its mesh nearest to where its bake starts.
  static Eigen::Isometry3d start_of(const Mesh& mesh, const GeometryCache& samples) {
    std::vector<Vec3> first;
    for (const Vec3f& p : samples.sample(0)) first.push_back(p.cast<double>());
    return rigid_fit(mesh.positions, first);
  }

  std::shared_ptr<const Mesh> mesh_;
  double preroll_;
  Eigen::Isometry3d start_;
  SampledTrajectory all_;
};

/// Straight between the frames.
class CarrierFlow final : public VertexFlow {
 public:
  /// frames: one after the other, the pre-roll's first; none: it stands.
  CarrierFlow(std::vector<Vec3f> frames, double fps, double preroll)
      : frames_(std::move(frames)), fps_(fps), preroll_(preroll) {}
  void sample(double time, std::span<Vec3> velocities) const override {
    const std::size_t n = velocities.size(), count = n > 0 ? frames_.size() / n : 0;
    const double frame = std::clamp((time + preroll_) * fps_, 0.0, count > 0 ? static_cast<double>(count - 1) : 0.0);
    const auto first = static_cast<std::size_t>(frame), next = std::min(first + 1, count > 0 ? count - 1 : 0);
    const double share = frame - static_cast<double>(first);
    for (std::size_t v = 0; v < n; ++v)
      velocities[v] = count == 0 ? Vec3::Zero()
                                 : Vec3((1 - share) * frames_[first * n + v].cast<double>() +
                                        share * frames_[next * n + v].cast<double>());
  }

 private:
  std::vector<Vec3f> frames_;
  double fps_, preroll_;
};

GeometryCache no_samples(const Carrier& carrier) {
  GeometryCache out;
  out.format = "baked before";
  out.mesh = *carrier.mesh;
  out.vertex_count = carrier.mesh->vertex_count();
  return out;
}

PrimaryPlan plan_of(const Carrier& carrier, const BakePlan& plan, GeometryCache samples, std::vector<Vec3f> flow = {}) {
  const Shot& shot = plan.shot();
  PrimaryPlan out;
  out.name = carrier.name;
  out.caches = carrier.caches;
  out.trajectory = std::make_shared<CarrierTrajectory>(carrier, std::move(samples), shot.preroll / shot.fps);
  if (carrier.liquid) out.flow = std::make_shared<CarrierFlow>(std::move(flow), shot.fps, shot.preroll / shot.fps);
  out.scan = plan.primaries[carrier.primary].scan;  // it is cut to where its primary is cut to
  out.info.format = "baked before";
  out.info.vertex_count = carrier.mesh->vertex_count();
  out.info.triangle_count = static_cast<int>(out.trajectory->surface().triangles.size());
  out.info.bind_bounds = bounds(carrier.mesh->positions);
  out.info.unit_scale = 1, out.info.up = std::string("y");
  return out;
}

/// A vector of each vertex in all frames, appended.
Status read_record(const Carrier& carrier, int frames, const std::filesystem::path& path, std::vector<Vec3f>& out) {
  auto reader = open_cache(path);
  if (!reader) return reader.error();
  const CacheInfo& info = (*reader)->info();
  if (info.frame_count != frames || info.vertex_count != carrier.mesh->vertex_count())
    return input_error(fmt::format("has {} frames of {} vertices, and the bake has {} of {}", info.frame_count,
                                   info.vertex_count, frames, carrier.mesh->vertex_count()),
                       path.string());
  std::vector<Vec3f> frame;
  for (int i = 0; i < frames; ++i) {
    if (const Status read = (*reader)->read_frame(i, frame); !read) return read.error();
    out.insert(out.end(), frame.begin(), frame.end());
  }
  return {};
}

}  // namespace

std::vector<Carrier> carriers_of(const BakePlan& plan) {
  std::vector<Carrier> out;
  for (const auto& group : plan.groups) {
    const SystemKind* kind = find_system_kind(group->role());
    if (!kind || !kind->section().why_no_carrier().empty()) continue;
    for (const SystemOutput& output : group->outputs) {
      if (!output.mesh) continue;
      out.push_back({std::string(kind->name()).append(".").append(output.mesh->name), output.mesh->name, output.mesh,
                     kind->is_sheet(), kind->is_liquid(), output.primary});
    }
  }
  return out;
}

PrimaryPlan standing_carrier(const Carrier& carrier, const BakePlan& plan) {
  GeometryCache samples = no_samples(carrier);
  const Eigen::Isometry3d start = plan.primaries[carrier.primary].trajectory->bind_to_start();
  for (const Vec3& p : carrier.mesh->positions) samples.positions.push_back((start * p).cast<float>());
  samples.times = {0};
  return plan_of(carrier, plan, std::move(samples));
}

Result<PrimaryPlan> moving_carrier(const Carrier& carrier, const BakePlan& plan, const BakeFolder& folder) {
  const Shot& shot = plan.shot();
  GeometryCache samples = no_samples(carrier);
  const int frames = shot.last_frame - shot.first_frame + shot.preroll + 1;
  if (const Status read = read_record(carrier, frames, folder.motion(carrier.caches), samples.positions); !read)
    return read.error();
  for (int i = 0; i < frames; ++i) samples.times.push_back(i / shot.fps);
  std::vector<Vec3f> flow;
  if (carrier.liquid)
    if (const Status read = read_record(carrier, frames, folder.flow(carrier.caches), flow); !read) return read.error();
  return plan_of(carrier, plan, std::move(samples), std::move(flow));
}

}  // namespace ft::inline baker

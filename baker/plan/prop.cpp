#include "baker/plan/prop.h"

#include <fmt/format.h>

#include <cmath>

#include "baker/core/equimomental.h"
#include "baker/core/shapes.h"
#include "solvers/standins/rigid_flight.h"

namespace ft::inline baker {
namespace {

constexpr int k_sphere_levels = 4;       ///< of a sphere's surface: its triangles lie within 0.2 % of the radius
constexpr double k_most_bending = 1e-3;  ///< that a rigid primary may deform, of its size [1]

constexpr double k_ground_side = 60, k_ground_depth = 1;  ///< m

/// `position` is a point of its upper side.
Vec3 ground_size(const PrimarySpec& spec) {
  return spec.size == Vec3::Zero() ? Vec3(k_ground_side, k_ground_depth, k_ground_side) : spec.size;
}

double release_time(const PrimarySpec& spec, const Shot& shot) {
  if (spec.shape == k_ground) return std::numeric_limits<double>::infinity();
  switch (spec.release) {
    case Release::k_start: return spec.shape.empty() ? std::numeric_limits<double>::infinity() : 0;
    case Release::k_frame: return (spec.release_frame - shot.first_frame) / shot.fps;
    case Release::k_contact: break;
  }
  return std::numeric_limits<double>::infinity();
}

/// Along `before`, and from the release on in free flight.
RigidTrack with_flight(RigidTrack before, double release, const RigidMass& mass, const Vec3& gravity) {
  if (!std::isfinite(release)) return before;
  RigidMass known = mass;
  if (!(known.mass > 0)) known.mass = 1;  // flight does not depend on it
  const RigidFlight flight(before(release), known, gravity);
  return [before = std::move(before), flight, release](double time) {
    return time < release ? before(time) : flight.at(time - release);
  };
}

/// An imported surface that moves as one.
class FittedTrack {
 public:
  FittedTrack(std::shared_ptr<const Trajectory> trajectory, std::vector<Vec3> body, double frame_time)
      : trajectory_(std::move(trajectory)), body_(std::move(body)), frame_time_(frame_time) {}

  RigidPose pose(double time, double* bending = nullptr) const {
    std::vector<Vec3> placed(body_.size());
    trajectory_->sample(time, placed);
    const Eigen::Isometry3d fit = rigid_fit(body_, placed);
    const RigidPose out{fit.translation(), Quat(fit.linear()).normalized()};
    if (bending)
      for (std::size_t i = 0; i < body_.size(); ++i) *bending = std::max(*bending, (out * body_[i] - placed[i]).norm());
    return out;
  }

  /// Velocities from the frames before: exact for constant acceleration, and what the animator sees of the motion that
  /// a release goes on with. Before the first frame of the shot there is none.
  RigidMotion motion(double time) const {
    const double t0 = std::max(time, 0.0);
    const RigidPose now = pose(time), before = pose(t0 - frame_time_), earlier = pose(t0 - 2 * frame_time_);
    RigidMotion out;
    out.pose = now;
    if (time < 0) return out;
    if (t0 < 2 * frame_time_) {  // nothing to look back to: ahead instead
      const RigidPose next = pose(t0 + frame_time_), later = pose(t0 + 2 * frame_time_);
      out.velocity = (-1.5 * now.position + 2 * next.position - 0.5 * later.position) / frame_time_;
      out.spin = rotation_vector(next.rotation * now.rotation.conjugate()) / frame_time_;
      return out;
    }
    out.velocity = (1.5 * now.position - 2 * before.position + 0.5 * earlier.position) / frame_time_;
    out.spin = rotation_vector(now.rotation * before.rotation.conjugate()) / frame_time_;
    return out;
  }

 private:
  std::shared_ptr<const Trajectory> trajectory_;
  std::vector<Vec3> body_;
  double frame_time_;
};

class PropTrajectory final : public Trajectory {
 public:
  PropTrajectory(const Prop& prop, RigidTrack track, double preroll)
      : body_(prop.surface), track_(std::move(track)), preroll_(preroll) {
    surface_.triangles = prop.triangles;
    surface_.part_of_vertex.assign(body_.size(), 0);
    surface_.parts = {{prop.name, -1, bounds(body_).size().prod()}};
  }
  const Surface& surface() const override { return surface_; }
  void bind_pose(std::span<Vec3> positions) const override { sample(-preroll_, positions); }
  void sample(double time, std::span<Vec3> positions) const override {
    const RigidPose pose = track_(time).pose;
    for (std::size_t i = 0; i < body_.size(); ++i) positions[i] = pose * body_[i];
  }
  Eigen::Isometry3d bind_to_start() const override { return Eigen::Isometry3d::Identity(); }
  double preroll() const override { return preroll_; }

 private:
  std::vector<Vec3> body_;
  RigidTrack track_;
  double preroll_;
  Surface surface_;
};

}  // namespace

Quat rotation_of_degrees(const Vec3& degrees) {
  const Vec3 angles = degrees * (EIGEN_PI / 180);
  return Eigen::AngleAxisd(angles.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angles.y(), Vec3::UnitY()) *
         Eigen::AngleAxisd(angles.x(), Vec3::UnitX());
}

Prop prop_of_shape(const PrimarySpec& spec, const Shot& shot) {
  Prop out;
  out.name = spec.name;
  const double kilograms = spec.mass.value_or(0), unit = kilograms > 0 ? kilograms : 1;
  const double radius = spec.radius.value_or(0);
  const bool ground = spec.shape == k_ground;
  TriangleSurface surface = spec.shape == "sphere" ? sphere_surface(radius, k_sphere_levels)
                            : spec.shape == "box"  ? box_surface(spec.size)
                            : ground               ? box_surface(ground_size(spec))
                                                   : capsule_surface(radius, spec.length.value_or(0), k_sphere_levels);
  out.mass = spec.hollow ? hollow_mass(surface.positions, surface.triangles, unit).mass
                         : filled_mass(surface.positions, surface.triangles, unit).mass;
  if (spec.shape == "sphere")  // its triangles lie a little inside
    out.mass.inertia = (spec.hollow ? 2.0 / 3 : 0.4) * unit * radius * radius * Mat3::Identity();
  if ((spec.inertia.array() > 0).all()) out.mass.inertia = spec.inertia.asDiagonal();
  out.mass.mass = kilograms;
  out.samples = spec.shape == "sphere" ? sphere_shape(radius)
                : spec.shape == "box"  ? box_shape(spec.size)
                : ground               ? box_shape(ground_size(spec))
                                       : surface_shape(surface.positions, surface.triangles);
  out.surface = std::move(surface.positions);
  out.triangles = std::move(surface.triangles);
  RigidMotion start;
  start.pose.position = spec.position;
  if (ground) start.pose.position.y() -= 0.5 * ground_size(spec).y();
  start.pose.rotation = rotation_of_degrees(spec.rotation_deg);
  const Vec3 velocity = spec.velocity, spin = spec.spin;
  out.release = release_time(spec, shot);
  out.release_on_contact = spec.release == Release::k_contact;
  const RigidTrack steady = [=](double time) {
    RigidMotion m = start;
    if (time < 0) return m;
    m.velocity = velocity;
    m.spin = spin;
    m.pose.position += time * velocity;
    m.pose.rotation = rotation_by(time * spin) * start.pose.rotation;
    return m;
  };
  out.track = with_flight(steady, out.release, out.mass, shot.solver.gravity);
  return out;
}

Result<Prop> prop_of_trajectory(const PrimarySpec& spec, const Shot& shot, std::shared_ptr<const Trajectory> trajectory,
                                double kilograms) {
  Prop out;
  out.name = spec.name;
  const Surface& surface = trajectory->surface();
  std::vector<Vec3> body(at(surface.vertex_count()));
  trajectory->sample(0, body);
  const double unit = kilograms > 0 ? kilograms : 1;
  BodyMass mass = spec.hollow ? hollow_mass(body, surface.triangles, unit) : filled_mass(body, surface.triangles, unit);
  for (Vec3& p : body) p -= mass.centre;
  const double size = bounds(body).size().maxCoeff();
  const FittedTrack track(trajectory, body, 1 / shot.fps);
  double bending = 0;
  int worst = shot.first_frame;
  for (int frame = shot.first_frame; frame <= shot.last_frame; ++frame) {
    double here = 0;
    track.pose((frame - shot.first_frame) / shot.fps, &here);
    if (here > bending) bending = here, worst = frame;
  }
  if (bending > k_most_bending * size)
    return usage_error(fmt::format("it is no rigid prop: at frame {} it has deformed by {:.3g} m", worst, bending),
                       shot.file.filename().string() + ": primary \"" + spec.name + "\"",
                       "cords, and couplings other than one-way, are for rigid props so far");
  out.mass = mass.mass;
  if ((spec.inertia.array() > 0).all()) out.mass.inertia = spec.inertia.asDiagonal();
  out.mass.mass = kilograms;
  out.samples = surface_shape(body, surface.triangles);
  out.surface = std::move(body);
  out.triangles = surface.triangles;
  out.release = release_time(spec, shot);
  out.release_on_contact = spec.release == Release::k_contact;
  out.track =
      with_flight([track](double time) { return track.motion(time); }, out.release, out.mass, shot.solver.gravity);
  return out;
}

std::unique_ptr<Trajectory> prop_trajectory(const Prop& prop, RigidTrack track, double preroll) {
  return std::make_unique<PropTrajectory>(prop, std::move(track), preroll);
}

}  // namespace ft::inline baker

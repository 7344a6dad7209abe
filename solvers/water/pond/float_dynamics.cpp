#include "solvers/water/pond/float_dynamics.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "baker/core/smooth_step.h"

namespace ft::inline solvers {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
/// Entry speeds over sqrt(g d) from which von Karman's loss begins and where it is whole: a bobbing sphere (0.2) loses
/// nothing to spray, a ball dropped from its diameter (1.7) does.
constexpr double k_no_slam = 0.3, k_full_slam = 1;
constexpr double k_wake_length = 1;  ///< way in which a wake forms, in diameters

using Mat36 = Eigen::Matrix<double, 3, 6>;

/// Velocity of a point at an arm from the centre of mass, from velocity and spin.
Mat36 at_arm(const Vec3& arm) {
  Mat36 out = Mat36::Zero();
  out.leftCols<3>().setIdentity();
  out.rightCols<3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(), -arm.x(), 0;
  return out;
}

/// Without what couples sideways and upwards.
Mat3 uncoupled(Mat3 a) {
  a(0, 1) = a(1, 0) = a(1, 2) = a(2, 1) = 0;
  return a;
}

/// Added mass over density times volume.
Mat3 added_ratio(const FloatModel& m, const Quat& rotation) {
  const Mat3 turn = rotation.toRotationMatrix();
  return uncoupled(turn * m.shape.added.asDiagonal() * turn.transpose());
}

/// By how much it changes when the body turns about an axis of the world.
Mat3 turned_ratio(const FloatModel& m, const Quat& rotation, int axis) {
  const Mat3 turn = rotation.toRotationMatrix();
  const Mat3 a = turn * m.shape.added.asDiagonal() * turn.transpose();
  Mat3 cross;
  const Vec3 e = Vec3::Unit(axis);
  cross << 0, -e.z(), e.y(), e.z(), 0, -e.x(), -e.y(), e.x(), 0;
  return uncoupled(cross * a - a * cross);
}

/// Of sideways parts those that act at once.
Mat3 at_once(Mat3 ratio, double share) {
  ratio(0, 0) *= share, ratio(0, 2) *= share, ratio(2, 0) *= share, ratio(2, 2) *= share;
  return ratio;
}

double shown_area(const FloatModel& m, const Quat& rotation, const Vec3& along) {
  const double speed = along.norm();
  if (speed == 0) return 0;
  if (m.shape.parts.front().ball_radius > 0) return m.shape.face.x();
  return (rotation.conjugate() * along).cwiseAbs().dot(m.shape.face) / speed;
}

Mat3 world_inertia(const RigidMass& mass, const Quat& rotation) {
  const Mat3 turn = rotation.toRotationMatrix();
  return turn * mass.inertia * turn.transpose();
}

/// Matrices of a body's motion, summed over its parts.
struct Equation {
  Mat6 mass = Mat6::Zero(), damping = Mat6::Zero();
  Vec6 force = Vec6::Zero();
};

/// Of one body, in Floats.
struct Memory {
  Vec3& wake;
  double &splash_energy, &splash_speed;
};

/// Share of the slam that an entry at that speed has: what bobs gently throws nothing off.
double slam_share(double speed, double gravity, double size) {
  return smooth_step((speed / std::sqrt(gravity * size) - k_no_slam) / (k_full_slam - k_no_slam));
}

void add_part(const FloatModel& m, const FloatWater& water, const RigidMotion& motion, std::size_t part,
              const FloatScratch& scratch, double time, Equation& eq, FloatLosses& losses, Memory memory) {
  const std::size_t b = m.first_part + part;
  const Submerged& wet = scratch.wet[b];
  const WaveProbe& probe = scratch.probes[b];
  const FloatPart& shape = m.shape.parts[part];
  if (wet.volume <= 0 && wet.area <= 0) return;
  const double displaced = water.density * wet.volume, g = water.gravity;
  const Mat3 ratio = added_ratio(m, motion.pose.rotation);
  const double share = wet.volume / shape.volume, sudden = sudden_share(share);
  const Vec3 source_arm = motion.pose.rotation * shape.centre;
  const Mat36 source = at_arm(source_arm), buoyed = at_arm(wet.centre - motion.pose.position);
  const Vec3 velocity = motion.velocity + motion.spin.cross(source_arm);
  const Vec3 flow(probe.velocity_x, probe.velocity_y, probe.velocity_z), relative = velocity - flow;

  const Mat3 added = displaced * at_once(ratio, sudden);
  eq.mass += source.transpose() * added * source;
  // What turning does to the added mass: -d(A v)/dt on the part, and the torque of 1/2 v A v.
  Vec3 change = added * motion.spin.cross(motion.spin.cross(source_arm));
  for (int axis = 0; axis < 3 && shape.ball_radius == 0; ++axis) {
    const Vec3 by_axis = displaced * (at_once(turned_ratio(m, motion.pose.rotation, axis), sudden) * velocity);
    change += motion.spin[axis] * by_axis;
    eq.force[3 + axis] += 0.5 * velocity.dot(by_axis);
  }
  eq.force -= source.transpose() * change;
  eq.force += buoyed.transpose() * Vec3(0, g * displaced, 0);
  const Vec3 slope(probe.slope_x, scratch.top_depth[b] > 0 ? probe.pull : 0, probe.slope_z);
  eq.force -= source.transpose() * ((displaced * g) * (slope + ratio * slope));

  // The added mass grows on the way in, with the volume, and sideways with the share that is under.
  const double growth = -wet.area * relative.y();  // m3/s
  const double sudden_growth = share > 0.5 && share < 1 ? sudden + 2 * (1 - sudden_share(0)) * share : sudden;
  const Mat3 gain = (water.density * growth) * at_once(ratio, sudden_growth);
  const double speed = relative.norm();
  if (growth > 0) {
    const double slam = slam_share(speed, g, m.shape.depth);
    eq.damping += (0.5 + 0.5 * slam) * source.transpose() * gain * source;
    eq.force -= source.transpose() * ((0.5 + 0.5 * slam) * gain * relative);
    const double power = 0.5 * slam * relative.dot(gain * relative);
    losses.slam += time * power;
    memory.splash_energy += time * power;
    if (slam > 0) memory.splash_speed = std::max(memory.splash_speed, speed);
  } else {
    eq.force -= source.transpose() * (0.5 * gain * relative);
  }
  // Only what has left a wake behind it has drag; of turning, all.
  const double in_wake = speed > 0 ? std::max(0.0, memory.wake.dot(relative)) / speed : 0;
  const double drag = 0.5 * water.density * m.drag * shown_area(m, motion.pose.rotation, relative) *
                      (wet.volume / m.shape.volume) * (in_wake + motion.spin.cross(source_arm).norm());
  eq.damping += drag * source.transpose() * source;
  eq.force -= drag * source.transpose() * relative;
  losses.drag += time * drag * relative.squaredNorm();
}

}  // namespace

std::vector<RigidPose> poses_of(const Floats& floats) {
  std::vector<RigidPose> out;
  for (const RigidMotion& m : floats.motion) out.push_back(m.pose);
  return out;
}

void place_sources(std::span<const FloatModel> models, const Floats& floats, FloatScratch& scratch) {
  std::size_t count = 0;
  for (const FloatModel& m : models) count += m.shape.parts.size();
  scratch.sources.assign(count, {});
  scratch.probes.assign(count, {});
  scratch.wet.assign(count, {});
  scratch.top_depth.assign(count, 0);
  scratch.level.assign(count, 0);
  for (std::size_t i = 0; i < models.size(); ++i)
    for (std::size_t p = 0; p < models[i].shape.parts.size(); ++p) {
      const std::size_t b = models[i].first_part + p;
      const FloatPart& part = models[i].shape.parts[p];
      WaveSource& s = scratch.sources[b];
      const Vec3 place = floats.motion[i].pose * part.centre;
      s.kernel = models[i].kernel.get();
      s.x = s.next_x = place.x(), s.z = s.next_z = place.z();
      scratch.wet[b] = submerged(part, floats.motion[i].pose, 0);
      scratch.top_depth[b] = s.top_depth = s.next_top_depth = std::max(0.0, -scratch.wet[b].top);
    }
}

void find_levels(std::span<const FloatModel> models, Floats& floats, FloatScratch& scratch) {
  struct Part {
    const FloatPart* shape;
    const RigidPose* pose;
    double self, depth;
  };
  std::vector<Part> parts;
  for (std::size_t i = 0; i < models.size(); ++i)
    for (const FloatPart& p : models[i].shape.parts) {
      const WaveSource& s = scratch.sources[parts.size()];
      const double d = models[i].kernel->depth, deep = d + s.next_top_depth;
      parts.push_back({&p, &floats.motion[i].pose, models[i].kernel->self_level * d * d / (deep * deep), deep});
    }
  // Others' new volumes reach a part by the estimate of point sources; what is wrong in it the next sweep corrects.
  const std::vector<double> before = floats.volume;
  const auto others = [&](std::size_t b) {
    double sum = 0;
    for (std::size_t c = 0; c < parts.size(); ++c) {
      if (c == b || floats.volume[c] == before[c]) continue;
      const double dx = scratch.sources[b].next_x - scratch.sources[c].next_x;
      const double dz = scratch.sources[b].next_z - scratch.sources[c].next_z;
      const double far = (dx * dx + dz * dz) / ((parts[b].depth + parts[c].depth) * (parts[b].depth + parts[c].depth));
      sum +=
          std::sqrt(parts[b].self * parts[c].self) / ((1 + far) * std::sqrt(1 + far)) * (floats.volume[c] - before[c]);
    }
    return sum;
  };
  for (std::size_t b = 0; b < parts.size(); ++b) scratch.level[b] = scratch.probes[b].level;
  for (int sweep = 0; sweep < 8; ++sweep) {
    double most = 0;
    for (std::size_t b = 0; b < parts.size(); ++b) {
      const Part& p = parts[b];
      const double base = scratch.probes[b].level + others(b);
      double& level = scratch.level[b];
      double change = 0;
      for (int n = 0; n < 12; ++n) {
        scratch.wet[b] = submerged(*p.shape, *p.pose, level);
        const double wrong = base + p.self * (scratch.wet[b].volume - before[b]) - level;
        change = wrong / std::max(1 - p.self * scratch.wet[b].area, 0.1);
        level += change;
        if (std::abs(change) < 1e-14) break;
      }
      scratch.wet[b] = submerged(*p.shape, *p.pose, level);
      most = std::max(most, std::abs(scratch.wet[b].volume - floats.volume[b]) / p.shape->volume);
      floats.volume[b] = scratch.wet[b].volume;
    }
    if (most < 1e-13) break;
  }
  for (std::size_t b = 0; b < parts.size(); ++b) {
    WaveSource& s = scratch.sources[b];
    s.volume = floats.volume[b] - before[b];
    s.x = s.next_x, s.z = s.next_z, s.top_depth = s.next_top_depth;
    s.way_x = s.way_z = s.sinking = 0;
    scratch.top_depth[b] = s.top_depth;
  }
}

void kick_floats(std::span<const FloatModel> models, const FloatWater& water, double time, const FloatScratch& scratch,
                 Floats& floats, FloatLosses& losses) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    const FloatModel& m = models[i];
    RigidMotion& motion = floats.motion[i];
    Equation eq;
    const Mat3 inertia = world_inertia(m.mass, motion.pose.rotation);
    eq.mass.topLeftCorner<3, 3>() = m.mass.mass * Mat3::Identity();
    eq.mass.bottomRightCorner<3, 3>() = inertia;
    eq.force << 0, -m.mass.mass * water.gravity, 0, -motion.spin.cross(inertia * motion.spin);
    for (std::size_t p = 0; p < m.shape.parts.size(); ++p)
      add_part(m, water, motion, p, scratch, time, eq, losses,
               {floats.wake[i], floats.splash_energy[i], floats.splash_speed[i]});
    Vec3 flow = Vec3::Zero();
    double volume = 0;
    for (std::size_t p = 0; p < m.shape.parts.size(); ++p) {
      const std::size_t b = m.first_part + p;
      const WaveProbe& probe = scratch.probes[b];
      flow += scratch.wet[b].volume * Vec3(probe.velocity_x, probe.velocity_y, probe.velocity_z);
      volume += scratch.wet[b].volume;
    }
    if (volume > 0) {
      const Vec3 relative = motion.velocity - flow / volume;
      const double size = 2 * std::cbrt(m.shape.volume * 3 / (4 * std::numbers::pi));
      floats.wake[i] += (1 - std::exp(-time * relative.norm() / (k_wake_length * size))) * (relative - floats.wake[i]);
    }
    const Vec6 change = (eq.mass + time * eq.damping).ldlt().solve(time * eq.force);
    motion.velocity += change.head<3>();
    motion.spin += change.tail<3>();
  }
}

void drift_floats(double time, Floats& floats) {
  for (RigidMotion& m : floats.motion) {
    m.pose.position += time * m.velocity;
    const double angle = time * m.spin.norm();
    if (angle > 1e-15)
      m.pose.rotation = (Quat(Eigen::AngleAxisd(angle, m.spin.normalized())) * m.pose.rotation).normalized();
  }
}

void move_sources(std::span<const FloatModel> models, std::span<const RigidMotion> before, const Floats& floats,
                  FloatScratch& scratch) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    const RigidPose& now = floats.motion[i].pose;
    const Mat3 ratio = added_ratio(models[i], now.rotation);
    for (std::size_t p = 0; p < models[i].shape.parts.size(); ++p) {
      const std::size_t b = models[i].first_part + p;
      const FloatPart& part = models[i].shape.parts[p];
      WaveSource& s = scratch.sources[b];
      const Vec3 place = now * part.centre, way = place - before[i].pose * part.centre;
      const double volume = floats.volume[b];
      const Vec3 moved = volume * (way + ratio * Vec3(way.x(), 0, way.z()));
      s.way_x = moved.x(), s.way_z = moved.z();
      s.next_x = place.x(), s.next_z = place.z();
      const Submerged at_level = submerged(part, now, scratch.level[b]);
      s.next_top_depth = std::max(0.0, scratch.level[b] - at_level.top);
      s.sinking = volume * (1 + ratio(1, 1)) * (s.next_top_depth - s.top_depth);
    }
  }
}

double float_energy(std::span<const FloatModel> models, const FloatWater& water, const Floats& floats,
                    const FloatScratch& scratch) {
  double sum = 0;
  for (std::size_t i = 0; i < models.size(); ++i) {
    const FloatModel& m = models[i];
    const RigidMotion& motion = floats.motion[i];
    sum += 0.5 * m.mass.mass * motion.velocity.squaredNorm() + m.mass.mass * water.gravity * motion.pose.position.y();
    sum += 0.5 * motion.spin.dot(world_inertia(m.mass, motion.pose.rotation) * motion.spin);
    const Mat3 ratio = added_ratio(m, motion.pose.rotation);
    for (std::size_t p = 0; p < m.shape.parts.size(); ++p) {
      const std::size_t b = m.first_part + p;
      const Submerged& wet = scratch.wet[b];
      const double displaced = water.density * wet.volume;
      const Vec3 velocity = motion.velocity_at(motion.pose * m.shape.parts[p].centre);
      const Mat3 added = displaced * at_once(ratio, sudden_share(wet.volume / m.shape.parts[p].volume));
      sum += 0.5 * velocity.dot(added * velocity) - water.gravity * displaced * wet.centre.y();
    }
  }
  return sum;
}

}  // namespace ft::inline solvers
